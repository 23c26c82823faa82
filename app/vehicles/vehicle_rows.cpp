#include "app/vehicles/vehicle_rows.hpp"

#include "app/cli/row_writer.hpp"
#include "estimator/identification/car_modes.hpp"
#include "estimator/smoother/car_tuning.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

namespace macadam {
namespace {

constexpr std::pair<std::string_view, std::string_view> built_in_words[] = {
    {"golden-car", "reference car of the IRI (ASTM E1926); simulations"},
    {"audi-a6-etron", "Audi A6 e-tron, identified on a measured road"},
    {"generic", "average passenger car, if nothing is known"},
    {"small-car", "any small car"},
    {"suv", "any SUV"},
    {"van", "any van"}};

double mass_kg(const HalfCar& car) {
    return car.ms_kg + 4 * car.mu_kg;
}

struct CarRow {
    const ListedVehicle& listed;
    CarModes modes;
};

Cell wheelbase_of(const CarRow& row) {
    const auto& axles = row.listed.vehicle.axles;
    return axles ? Cell{axles->wheelbase_m} : Cell{};
}

// clang-format off
const Columns<CarRow> car_columns{
    {"name", as::text, [](auto& r) { return r.listed.vehicle.name; }, {"name", "{:<16}"}},
    {"mass_kg", as::real(0, "kg"), [](auto& r) { return mass_kg(r.listed.vehicle.half_car); }, {"mass kg", " {:>7}"}},
    {"wheelbase_m", as::metres(2), wheelbase_of, {"wheelbase", " {:>9}"}},
    {"bounce_hz", as::real(2, "Hz"), [](auto& r) { return r.modes.bounce_hz; }, {"body Hz", " {:>7}"}},
    {"bounce_damping", as::real(2), [](auto& r) { return r.modes.bounce_damping; }, {"damping", " {:>7}"}},
    {"hop_hz", as::real(1, "Hz"), [](auto& r) { return r.modes.hop_hz; }, {"wheel Hz", " {:>8}"}},
    {"iri_relative_sd", as::real(3), [](auto& r) { return untuned_iri_sd(r.listed.vehicle, true); }},
    {"", as::text,
     [](auto& r) { return fmt::format("{:.0f} %", 100 * untuned_iri_sd(r.listed.vehicle, true)); },
     {"IRI +-", " {:>6}"}},
    {"stands_for", as::text, [](auto& r) { return r.listed.stands_for; }, {"stands for", "  {}"}},
};
// clang-format on

struct Parameter {
    std::string_view key; ///< of the vehicle file, or a derived value
    std::optional<double> value;
    std::string_view unit;
    std::string_view words;
    std::optional<double> relative_sd{};
};

std::vector<Parameter> parameters_of(const Vehicle& vehicle) {
    const auto& car = vehicle.half_car;
    const auto modes = modes_of(car);
    std::vector<Parameter> parameters{
        {"ms_kg", car.ms_kg, "kg", "sprung mass, whole car"},
        {"mu_kg", car.mu_kg, "kg", "unsprung mass, each wheel"},
        {"ks_n_per_m", car.ks_n_per_m, "N/m", "suspension stiffness, each wheel"},
        {"cs_ns_per_m", car.cs_ns_per_m, "N s/m", "suspension damping, each wheel"},
        {"kt_n_per_m", car.kt_n_per_m, "N/m", "tyre stiffness"},
        {"friction_n", car.friction_n, "N", "dry friction, each suspension"},
        {"is_kgm2", car.is_kgm2, "kg m2", "roll inertia of half the body"},
        {"l_m", car.l_m, "m", "half the track width"}};
    if (const auto& axles = vehicle.axles) {
        parameters.insert(parameters.end(),
                          {{"wheelbase_m", axles->wheelbase_m, "m", "wheelbase"},
                           {"cg_to_front_m",
                            axles->cg_to_front_m,
                            "m",
                            "centre of gravity behind "
                            "the front axle"},
                           {"dynamic_index", axles->dynamic_index, "", "k^2 / (a b) in pitch"},
                           {"rear_ratio",
                            axles->rear_ratio,
                            "",
                            "rear over front, springs and "
                            "dampers"}});
    }
    parameters.insert(parameters.end(),
                      {{"gain", vehicle.gain, "", "sensor over model"},
                       {"x_m", vehicle.imu.x_m, "m", "sensor ahead of the centre of gravity"},
                       {"y_m", vehicle.imu.y_m, "m", "sensor left of the middle"},
                       {"bounce_hz", modes.bounce_hz, "Hz", "body bounce"},
                       {"bounce_damping",
                        modes.bounce_damping,
                        "",
                        "its fraction of critical "
                        "damping"},
                       {"hop_hz", modes.hop_hz, "Hz", "wheel hop"}});
    for (auto& parameter : parameters) {
        const auto found = vehicle.uncertainty.find(std::string{parameter.key});
        if (found != vehicle.uncertainty.end()) {
            parameter.relative_sd = found->second;
        }
    }
    return parameters;
}

std::string value_words(const Parameter& row) {
    if (!row.value) {
        return "from drive";
    }
    return *row.value >= 1000 ? fmt::format("{:.0f}", *row.value)
                              : fmt::format("{:.4g}", *row.value);
}

std::string sd_words(const Parameter& row) {
    return row.relative_sd ? fmt::format("{:.0f} %", 100 * *row.relative_sd) : "";
}

// clang-format off
const Columns<Parameter> parameter_columns{
    {"parameter", as::text, [](auto& r) { return r.key; }, {"parameter", "{:<15}"}},
    {"value", as::shortest, [](auto& r) { return r.value; }},
    {"", as::text, value_words, {"value", " {:>10}"}},
    {"unit", as::text, [](auto& r) { return r.unit; }, {"unit", " {:<6}"}},
    {"relative_sd", as::shortest, [](auto& r) { return r.relative_sd; }},
    {"", as::text, sd_words, {"+-", " {:>5}"}},
    {"meaning", as::text, [](auto& r) { return r.words; }, {"meaning", "  {}"}},
};
// clang-format on

} // namespace

std::vector<ListedVehicle> listed_built_in_vehicles() {
    std::vector<ListedVehicle> listed;
    for (const auto& vehicle : built_in_vehicles()) {
        const auto* const words = std::ranges::find(
            built_in_words, vehicle.name, &std::pair<std::string_view, std::string_view>::first);
        listed.push_back({vehicle, std::string{words->second}});
    }
    return listed;
}

std::string vehicles_text(std::span<const ListedVehicle> vehicles, std::string_view format) {
    std::vector<CarRow> rows;
    for (const auto& listed : vehicles) {
        rows.push_back({listed, modes_of(listed.vehicle.half_car)});
    }
    return rows_text(car_columns, rows, format);
}

std::string parameters_text(const Vehicle& vehicle, std::string_view format) {
    return rows_text(parameter_columns, parameters_of(vehicle), format);
}

std::vector<std::string> implausible_in(const Vehicle& vehicle) {
    struct Usual {
        std::string_view words;
        double value;
        double min;
        double max;
        std::string_view unit;
        std::string_view suspects;
    };
    const auto& car = vehicle.half_car;
    const auto modes = modes_of(car);
    // Wider than textbooks: any car that is driven on roads lies within.
    std::vector<Usual> usual{
        {"mass", mass_kg(car), 500, 5000, " kg", "ms_kg is of the whole car"},
        {"body bounce", modes.bounce_hz, 0.8, 2.5, " Hz", "check ms_kg and ks_n_per_m"},
        {"damping", modes.bounce_damping, 0.1, 0.7, " of critical", "check cs_ns_per_m"},
        {"wheel hop", modes.hop_hz, 8, 18, " Hz", "check mu_kg and kt_n_per_m"},
        {"track width", 2 * car.l_m, 1.1, 2.2, " m", "l_m is half of it"}};
    if (const auto& axles = vehicle.axles) {
        usual.push_back({"wheelbase", axles->wheelbase_m, 1.6, 5, " m", "check wheelbase_m"});
        usual.push_back({"share of the front axle",
                         100 * (1 - axles->cg_to_front_m / axles->wheelbase_m),
                         30,
                         75,
                         " %",
                         "check cg_to_front_m"});
    }
    std::vector<std::string> sentences;
    for (const auto& [words, value, min, max, unit, suspects] : usual) {
        if (value < min || value > max) {
            sentences.push_back(fmt::format("{} is {:.3g}{}, usual are {:.3g} to {:.3g}{}: {}",
                                            words,
                                            value,
                                            unit,
                                            min,
                                            max,
                                            unit,
                                            suspects));
        }
    }
    return sentences;
}

} // namespace macadam
