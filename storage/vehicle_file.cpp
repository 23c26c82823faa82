#include "storage/vehicle_file.hpp"

#include "estimator/common/error.hpp"
#include "storage/byte_stream.hpp"
#include "storage/text.hpp"

#include <fmt/core.h>

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {

namespace {

/// What a number may be.
struct Range {
    bool (*holds)(double);
    const char* words;
};

constexpr Range positive{[](double x) { return x > 0; }, "a number above 0"};
constexpr Range not_negative{[](double x) { return x >= 0; }, "a number of 0 or more"};
constexpr Range order{[](double x) { return x >= 1 && x <= 8 && x == std::floor(x); },
                      "a whole number from 1 to 8"};
// Sensors sit in cars; metres that are not are millimetres.
constexpr Range in_car{[](double x) { return std::abs(x) <= 20; }, "metres, from -20 to 20"};

struct Key {
    std::string_view table; ///< "" = at the top
    std::string_view name;
    Range range;
    bool needed; ///< where its table stands
    double& (*place)(Vehicle&);
};

// clang-format off
constexpr Key number_keys[] = {
    {"", "gain", positive, false, [](Vehicle& v) -> double& { return v.gain; }},
    {"half_car", "ms_kg", positive, true, [](Vehicle& v) -> double& { return v.half_car.ms_kg; }},
    {"half_car", "mu_kg", positive, true, [](Vehicle& v) -> double& { return v.half_car.mu_kg; }},
    {"half_car", "ks_n_per_m", positive, true, [](Vehicle& v) -> double& { return v.half_car.ks_n_per_m; }},
    {"half_car", "cs_ns_per_m", positive, true, [](Vehicle& v) -> double& { return v.half_car.cs_ns_per_m; }},
    {"half_car", "kt_n_per_m", positive, true, [](Vehicle& v) -> double& { return v.half_car.kt_n_per_m; }},
    {"half_car", "is_kgm2", positive, true, [](Vehicle& v) -> double& { return v.half_car.is_kgm2; }},
    {"half_car", "l_m", positive, true, [](Vehicle& v) -> double& { return v.half_car.l_m; }},
    {"axles", "wheelbase_m", positive, true, [](Vehicle& v) -> double& { return v.axles->wheelbase_m; }},
    {"axles", "cg_to_front_m", positive, true, [](Vehicle& v) -> double& { return v.axles->cg_to_front_m; }},
    {"axles", "dynamic_index", positive, false, [](Vehicle& v) -> double& { return v.axles->dynamic_index; }},
    {"axles", "rear_ratio", positive, false, [](Vehicle& v) -> double& { return v.axles->rear_ratio; }},
    {"imu", "x_m", in_car, false, [](Vehicle& v) -> double& { return v.imu.x_m; }},
    {"imu", "y_m", in_car, false, [](Vehicle& v) -> double& { return v.imu.y_m; }},
    {"imu", "height_above_roll_axis_m", in_car, false, [](Vehicle& v) -> double& { return v.imu.height_above_roll_axis_m; }},
    {"imu", "lowpass_hz", not_negative, false, [](Vehicle& v) -> double& { return v.imu.lowpass_hz; }},
    {"imu", "noise_mps2", positive, false, [](Vehicle& v) -> double& { return v.imu.noise_mps2; }},
    {"imu", "noise_radps", positive, false, [](Vehicle& v) -> double& { return v.imu.noise_radps; }},
};
// clang-format on
constexpr std::string_view order_key = "lowpass_order"; // of [imu]: the one whole number
constexpr std::string_view table_names[] = {"half_car", "axles", "imu", "uncertainty"};

/// Where a message points to.
struct Place {
    std::string file;
    toml::source_index line;
};

[[noreturn]] void fail(const Place& at, std::string_view what) {
    throw InputError{fmt::format("{}:{}: {}", at.file, std::max(at.line, 1U), what)};
}

toml::table parse(const std::filesystem::path& file) {
    constexpr std::size_t most_bytes = 1 << 20; // a vehicle takes one thousand
    std::string text(most_bytes, '\0');
    std::size_t size = 0;
    const auto bytes = file_bytes(file);
    while (const auto count = bytes->read(std::span{text}.subspan(size))) {
        size += count;
    }
    if (size == most_bytes) {
        throw InputError{
            fmt::format("{}: is larger than 1 MiB, expected a vehicle", file.string())};
    }
    text.resize(size);
    try {
        return toml::parse(text, file.string());
    } catch (const toml::parse_error& error) {
        fail({file.string(), error.source().begin.line}, error.description());
    }
}

/// One table of the file, as its keys are found in it.
class Section {
public:
    Section(const toml::table& table, std::string name, std::string file)
        : table_{table}, name_{std::move(name)}, file_{std::move(file)} {}

    bool has(std::string_view key) const { return table_.contains(key); }

    std::optional<Section> section(std::string_view name) const {
        const auto* const node = table_.get(name);
        if (node == nullptr) {
            return {};
        }
        if (!node->is_table()) {
            fail(at(*node), fmt::format("'{}' is {}, expected [{}]", name, shown(*node), name));
        }
        return Section{*node->as_table(), std::string{name}, file_};
    }

    double number(std::string_view key, const Range& range) const {
        const auto& node = *table_.get(key);
        const auto value = node.is_number() ? node.value<double>() : std::nullopt;
        if (!value || !std::isfinite(*value) || !range.holds(*value)) {
            fail(at(node),
                 fmt::format("{} is {}, expected {}", full(key), shown(node), range.words));
        }
        return *value;
    }

    std::string text(std::string_view key) const {
        const auto& node = *table_.get(key);
        const auto value = node.value<std::string>();
        if (!value || value->empty()) {
            fail(at(node), fmt::format("{} is {}, expected a text", full(key), shown(node)));
        }
        return *value;
    }

    template <typename Known>
    void expect_only(Known is_known) const {
        for (const auto& [key, node] : table_) {
            if (!is_known(key.str())) {
                fail({file_, key.source().begin.line},
                     fmt::format("the key {} is not known (docs/formats.md lists them)",
                                 full(key.str())));
            }
        }
    }

    std::vector<std::string> keys() const {
        std::vector<std::string> names;
        for (const auto& [key, node] : table_) {
            names.emplace_back(key.str());
        }
        return names;
    }

    [[noreturn]] void miss(std::string_view key) const {
        fail(at(table_), fmt::format("the key {} is missing", full(key)));
    }

    [[noreturn]] void refuse(std::string_view key, std::string_view expected) const {
        const auto& node = *table_.get(key);
        fail(at(node), fmt::format("{} is {}, expected {}", full(key), shown(node), expected));
    }

private:
    Place at(const toml::node& node) const { return {file_, node.source().begin.line}; }

    std::string full(std::string_view key) const {
        return name_.empty() ? fmt::format("'{}'", key) : fmt::format("'{}.{}'", name_, key);
    }

    static std::string shown(const toml::node& node) {
        if (const auto text = node.value_exact<std::string>()) {
            return in_quotes(*text);
        }
        if (const auto number = node.value<double>(); number && node.is_number()) {
            return fmt::format("'{}'", *number);
        }
        if (const auto flag = node.value_exact<bool>()) {
            return *flag ? "'true'" : "'false'";
        }
        return node.is_table() ? "a table" : node.is_array() ? "an array" : "a date";
    }

    const toml::table& table_;
    std::string name_;
    std::string file_;
};

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

/// `vehicle` with the numbers of one of the file's tables.
Vehicle with_numbers(Vehicle vehicle, const Section& section, std::string_view table) {
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

/// The same of a table that holds nothing but numbers.
Vehicle with_table(Vehicle vehicle, const Section& section, std::string_view table) {
    section.expect_only([&](std::string_view name) {
        return is_number_key(table, name) || (table == "imu" && name == order_key);
    });
    return with_numbers(std::move(vehicle), section, table);
}

Vehicle with_axles(Vehicle vehicle, const Section& axles) {
    vehicle.axles.emplace();
    vehicle = with_table(std::move(vehicle), axles, "axles");
    if (vehicle.axles->cg_to_front_m >= vehicle.axles->wheelbase_m) {
        axles.refuse("cg_to_front_m", "less than wheelbase_m");
    }
    return vehicle;
}

Vehicle with_imu(Vehicle vehicle, const Section& imu) {
    vehicle = with_table(std::move(vehicle), imu, "imu");
    if (imu.has(order_key)) {
        vehicle.imu.lowpass_order = static_cast<int>(imu.number(order_key, order));
    }
    return vehicle;
}

Vehicle with_uncertainty(Vehicle vehicle, const Section& uncertainty) {
    uncertainty.expect_only(is_any_number_key);
    for (const auto& key : uncertainty.keys()) {
        vehicle.uncertainty[key] = uncertainty.number(key, not_negative);
    }
    return vehicle;
}

} // namespace

Vehicle read_vehicle(const std::filesystem::path& file) {
    const auto root = parse(file);
    const Section top{root, "", file.string()};
    top.expect_only(is_top_key);
    if (!top.has("name")) {
        top.miss("name");
    }
    const auto half_car = top.section("half_car");
    if (!half_car) {
        top.miss("half_car");
    }

    Vehicle vehicle{
        .name = top.text("name"), .half_car = {}, .axles = {}, .imu = {}, .uncertainty = {}};
    vehicle = with_numbers(std::move(vehicle), top, "");
    vehicle = with_table(std::move(vehicle), *half_car, "half_car");
    if (const auto axles = top.section("axles")) {
        vehicle = with_axles(std::move(vehicle), *axles);
    }
    if (const auto imu = top.section("imu")) {
        vehicle = with_imu(std::move(vehicle), *imu);
    }
    if (const auto uncertainty = top.section("uncertainty")) {
        vehicle = with_uncertainty(std::move(vehicle), *uncertainty);
    }
    return vehicle;
}

} // namespace macadam
