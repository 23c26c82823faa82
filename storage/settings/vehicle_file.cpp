#include "storage/settings/vehicle_file.hpp"

#include "estimator/vehicle/vehicle_prior.hpp"
#include "storage/tables/toml.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace macadam {

namespace {

constexpr TomlRange order{[](double x) { return x >= 1 && x <= 8 && x == std::floor(x); },
                          "a whole number from 1 to 8"};
// Sensors are inside the car; larger values are probably millimetres.
constexpr TomlRange long_car{[](double x) { return x > 0 && x <= 20; },
                             "metres, above 0 and at most 20"};
constexpr TomlRange in_car{[](double x) { return std::abs(x) <= 20; }, "metres, from -20 to 20"};

struct Key {
    std::string_view table; ///< "" = root table
    std::string_view name;
    TomlRange range;
    bool needed; ///< if its table exists
    double& (*place)(Vehicle&);
};

// clang-format off
constexpr Key number_keys[] = {
    {"", "gain", positive_number, false, [](Vehicle& v) -> double& { return v.gain; }},
    {"", "one_axle_gain", positive_number, false, [](Vehicle& v) -> double& { return v.one_axle_gain.emplace(); }},
    {"half_car", "ms_kg", positive_number, true, [](Vehicle& v) -> double& { return v.half_car.ms_kg; }},
    {"half_car", "mu_kg", positive_number, true, [](Vehicle& v) -> double& { return v.half_car.mu_kg; }},
    {"half_car", "ks_n_per_m", positive_number, true, [](Vehicle& v) -> double& { return v.half_car.ks_n_per_m; }},
    {"half_car", "cs_ns_per_m", positive_number, true, [](Vehicle& v) -> double& { return v.half_car.cs_ns_per_m; }},
    {"half_car", "kt_n_per_m", positive_number, true, [](Vehicle& v) -> double& { return v.half_car.kt_n_per_m; }},
    {"half_car", "is_kgm2", positive_number, true, [](Vehicle& v) -> double& { return v.half_car.is_kgm2; }},
    {"half_car", "l_m", positive_number, true, [](Vehicle& v) -> double& { return v.half_car.l_m; }},
    {"half_car", "antiroll_n_per_m", not_negative_number, false, [](Vehicle& v) -> double& { return v.half_car.antiroll_n_per_m; }},
    {"half_car", "friction_n", not_negative_number, false, [](Vehicle& v) -> double& { return v.half_car.friction_n.emplace(); }},
    {"axles", "wheelbase_m", long_car, true, [](Vehicle& v) -> double& { return v.axles->wheelbase_m; }},
    {"axles", "cg_to_front_m", positive_number, true, [](Vehicle& v) -> double& { return v.axles->cg_to_front_m; }},
    {"axles", "dynamic_index", positive_number, false, [](Vehicle& v) -> double& { return v.axles->dynamic_index; }},
    {"axles", "rear_ratio", positive_number, false, [](Vehicle& v) -> double& { return v.axles->rear_ratio; }},
    {"imu", "x_m", in_car, false, [](Vehicle& v) -> double& { return v.imu.x_m; }},
    {"imu", "y_m", in_car, false, [](Vehicle& v) -> double& { return v.imu.y_m; }},
    {"imu", "height_above_roll_axis_m", in_car, false, [](Vehicle& v) -> double& { return v.imu.height_above_roll_axis_m; }},
    {"imu", "lowpass_hz", not_negative_number, false, [](Vehicle& v) -> double& { return v.imu.lowpass_hz; }},
    {"imu", "noise_mps2", positive_number, false, [](Vehicle& v) -> double& { return v.imu.noise_mps2; }},
    {"imu", "noise_radps", positive_number, false, [](Vehicle& v) -> double& { return v.imu.noise_radps; }},
};
// clang-format on
constexpr std::string_view order_key = "lowpass_order"; // of [imu]; the only integer
constexpr std::string_view table_names[] = {"half_car", "axles", "imu", "uncertainty"};

bool is_number_key(std::string_view table, std::string_view name) {
    return std::any_of(std::begin(number_keys), std::end(number_keys), [&](const Key& key) {
        return key.table == table && key.name == name;
    });
}

bool is_any_number_key(std::string_view name) {
    return std::any_of(std::begin(number_keys), std::end(number_keys), [&](const Key& key) {
        return key.name == name;
    });
}

bool is_top_key(std::string_view name) {
    return name == "name" || is_number_key("", name) ||
           std::find(std::begin(table_names), std::end(table_names), name) != std::end(table_names);
}

template <typename Known>
void expect_only(const TomlTable& table, Known is_known) {
    for (const auto& key : table.keys()) {
        if (!is_known(key)) {
            table.refuse_unknown(key, "one of docs/reference/vehicles.md");
        }
    }
}

/// Copy of `vehicle` with the numbers of one table of the file.
Vehicle with_numbers(Vehicle vehicle, const TomlTable& section, std::string_view table) {
    for (const auto& key : number_keys) {
        if (key.table != table) {
            continue;
        }
        if (section.has(key.name)) {
            key.place(vehicle) = section.number(key.name, key.range);
        } else if (key.needed) {
            section.miss(key.name);
        }
    }
    return vehicle;
}

/// Same for a table that holds only numbers.
Vehicle with_table(Vehicle vehicle, const TomlTable& section, std::string_view table) {
    expect_only(section, [&](std::string_view name) {
        return is_number_key(table, name) || (table == "imu" && name == order_key);
    });
    return with_numbers(std::move(vehicle), section, table);
}

Vehicle with_axles(Vehicle vehicle, const TomlTable& axles) {
    vehicle.axles.emplace();
    vehicle = with_table(std::move(vehicle), axles, "axles");
    if (vehicle.axles->cg_to_front_m >= vehicle.axles->wheelbase_m) {
        axles.refuse("cg_to_front_m", "less than wheelbase_m");
    }
    return vehicle;
}

Vehicle with_imu(Vehicle vehicle, const TomlTable& imu) {
    vehicle = with_table(std::move(vehicle), imu, "imu");
    if (imu.has("lowpass_hz") && vehicle.imu.lowpass_hz == 0) {
        vehicle.imu.lowpass_hz = no_lowpass_hz;
    }
    if (imu.has(order_key)) {
        vehicle.imu.lowpass_order = static_cast<int>(imu.number(order_key, order));
    }
    return vehicle;
}

Vehicle with_uncertainty(Vehicle vehicle, const TomlTable& uncertainty) {
    expect_only(uncertainty, is_any_number_key);
    for (const auto& key : uncertainty.keys()) {
        vehicle.uncertainty[key] = uncertainty.number(key, not_negative_number);
    }
    return vehicle;
}

} // namespace

Vehicle read_vehicle(const std::filesystem::path& file) {
    const auto top = read_toml(file, "a vehicle");
    expect_only(top, is_top_key);
    if (!top.has("name")) {
        top.miss("name");
    }
    const auto half_car = top.table("half_car");
    if (!half_car) {
        top.miss("half_car");
    }

    Vehicle vehicle{.name = top.text("name"),
                    .one_axle_gain = {},
                    .half_car = {},
                    .axles = {},
                    .imu = {},
                    .uncertainty = {}};
    vehicle = with_numbers(std::move(vehicle), top, "");
    vehicle = with_table(std::move(vehicle), *half_car, "half_car");
    if (const auto axles = top.table("axles")) {
        vehicle = with_axles(std::move(vehicle), *axles);
    }
    if (vehicle.axles && !top.table("axles")->has("dynamic_index")) {
        vehicle.uncertainty["dynamic_index"] = unstated_dynamic_index_sd;
    }
    if (const auto imu = top.table("imu")) {
        vehicle = with_imu(std::move(vehicle), *imu);
    }
    if (const auto uncertainty = top.table("uncertainty")) {
        vehicle = with_uncertainty(std::move(vehicle), *uncertainty);
    }
    return vehicle;
}

} // namespace macadam
