#include "estimator/vehicle/vehicle_prior.hpp"

#include "estimator/common/gravity.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>

namespace macadam {
namespace {

constexpr int wheels = 4;
constexpr double usual_lowpass_over_rate = 0.4;

// Frequencies of the body: 1.0 to 1.5 Hz in passenger cars (T. D. Gillespie, "Fundamentals of
// Vehicle Dynamics", SAE 1992, chapter 5); soft in saloons, harder where a load is to be carried.
// Ranges hold the usual cars of the kind, heavy electric ones and crew cabs included.
// clang-format off
constexpr std::array<BodyType, 7> types{{
    {"small",   {600, 1600},  {1.70, 2.65}, 1.35, 0.72, 0.60, 0.125},
    {"compact", {800, 2200},  {2.35, 2.90}, 1.30, 0.77, 0.60, 0.120},
    {"saloon",  {900, 2700},  {2.35, 3.40}, 1.20, 0.79, 0.55, 0.115},
    {"estate",  {900, 2700},  {2.35, 3.20}, 1.25, 0.79, 0.56, 0.120},
    {"suv",     {1000, 4300}, {2.20, 4.60}, 1.30, 0.80, 0.55, 0.125},
    {"van",     {1100, 3500}, {2.50, 4.70}, 1.45, 0.83, 0.56, 0.125},
    {"pickup",  {1300, 4300}, {2.60, 4.60}, 1.50, 0.81, 0.56, 0.130},
}};
// clang-format on

constexpr double bounce_sd = 0.10; // relative: most cars of a kind lie within 20 %

/// Fraction of critical damping, C / sqrt(4 K M): 0.2 to 0.4 (Gillespie, chapter 5).
constexpr double damping = 0.30;
constexpr double damping_sd = 0.06;

/// Papers may or may not count the driver, who is in the car, and never passengers and luggage.
constexpr double load_kg = 30;
constexpr double load_sd_kg = 60;

constexpr double unsprung_sd = 0.15;
constexpr double half_track_sd = 0.03;
constexpr double front_share_sd = 0.03;
constexpr double stated_front_share_sd = 0.01;

/// Deflection of a tyre under its share of the car, by which its stiffness follows the load: 163
/// kN/m under 2.8 kN for the golden car of ASTM E1926.
constexpr double tyre_deflection_m = 0.0175;
constexpr double tyre_sd = 0.15;
constexpr double sized_tyre_sd = 0.10; // of the formula, and of pressures of 2.1 to 2.6 bar
constexpr double tyre_pressure_kpa = 235;

/// Radius of gyration in roll over the track width, by the measured inertias of 1998 and before (G.
/// J. Heydinger et al., "Measured vehicle inertial parameters", SAE 1999-01-1336).
constexpr double roll_radius_over_track = 0.40;
constexpr double roll_inertia_sd = 0.15;

/// Frequency of the rear over that of the front; the rear is faster, so that pitching dies out
/// behind a bump (M. Olley; Gillespie, chapter 5).
constexpr double rear_over_front_hz = 1.15;
constexpr double rear_ratio_sd = 0.12;

/// A sensor on the dashboard. 0.25 m to either side changes what it reads by some 5 %, as the
/// wheelbase filters the road (docs/method/identification.md).
constexpr double dashboard_m = 0.95;
constexpr double unknown_place_gain_sd = 0.05;
constexpr double fixed_gain_sd = 0.02;
constexpr double holder_gain_sd = 0.06;

constexpr double one_axle_gain = 0.72; // docs/method/identification.md

/// Stiffness in N/m by T. B. Rhyne, "Development of a vertical stiffness relationship for belted
/// radial tires", Tire Science and Technology 33(3), 2005.
double stiffness_of(const TyreSize& tyre) {
    const double belt_width_mm = (1.03 - 0.004 * tyre.aspect_percent) * tyre.width_mm;
    const double diameter_mm = tyre.width_mm * tyre.aspect_percent / 50 + 25.4 * tyre.rim_in;
    const double kgf_per_mm =
        0.00028 * tyre_pressure_kpa * std::sqrt(belt_width_mm * diameter_mm) + 3.45;
    return kgf_per_mm * standard_gravity_mps2 * 1000;
}

/// Reads a number at the beginning of a text and removes it; 0 if there is none.
double take_number(std::string_view& text) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return error == std::errc{} ? number : 0;
}

/// Tells whether text is what may follow a size on a tyre, if anything: C, and load index and
/// speed, such as " 91V", "C 107/105T" or " 95(W) XL".
bool is_service(std::string_view text) {
    constexpr std::size_t max_bytes = 20;
    text.remove_prefix(text.starts_with('C') || text.starts_with('c') ? 1 : 0);
    return text.empty() || (text.starts_with(' ') && text.size() <= max_bytes &&
                            text.find_first_not_of("0123456789/ ()ABCDEFGHJKLMNPQRSTUVWXYZ"
                                                   "abcdefghjklmnpqrstuvwxyz") == text.npos);
}

double square(double x) {
    return x * x;
}

struct EstimatedValue {
    double value;
    double sd; ///< relative
};

EstimatedValue tyre_stiffness(const OwnersData& known) {
    if (known.tyres) {
        return {stiffness_of(*known.tyres), sized_tyre_sd};
    }
    const double load_n = (known.mass_kg + load_kg) / wheels * standard_gravity_mps2;
    return {load_n / tyre_deflection_m, tyre_sd};
}

/// Suspension stiffness with which a body on springs and tyres has the natural frequency.
double spring_stiffness(double sprung_kg, double bounce_hz, double kt_n_per_m) {
    const double in_series = sprung_kg * square(2 * std::numbers::pi * bounce_hz);
    return in_series * kt_n_per_m / (kt_n_per_m - in_series);
}

} // namespace

std::span<const BodyType> body_types() {
    return types;
}

std::optional<TyreSize> parse_tyre_size(std::string_view text) {
    constexpr ValueRange widths_mm{125, 355};
    constexpr ValueRange aspects{25, 85};
    constexpr ValueRange rims_in{12, 24};
    TyreSize tyre{};
    for (const std::string_view kind : {"P", "LT", "p", "lt"}) { // passenger car, light truck
        text.remove_prefix(text.starts_with(kind) ? kind.size() : 0);
    }
    tyre.width_mm = take_number(text);
    if (!text.starts_with('/')) {
        return {};
    }
    text.remove_prefix(1);
    tyre.aspect_percent = take_number(text);
    for (const char letter : {' ', 'Z', 'z', 'R', 'r', ' '}) {
        text.remove_prefix(text.starts_with(letter) ? 1 : 0);
    }
    tyre.rim_in = take_number(text);
    const bool is_tyre = is_service(text) && widths_mm.contains(tyre.width_mm) &&
                         aspects.contains(tyre.aspect_percent) && rims_in.contains(tyre.rim_in);
    return is_tyre ? std::optional{tyre} : std::nullopt;
}

Vehicle vehicle_of(const OwnersData& known, std::string name) {
    const auto& body = known.body;
    const double mu_kg = body.unsprung_share * known.mass_kg / wheels;
    const double ms_kg = known.mass_kg + load_kg - wheels * mu_kg;
    const auto tyre = tyre_stiffness(known);
    const double quarter_kg = ms_kg / wheels;
    const double ks = spring_stiffness(quarter_kg, body.bounce_hz, tyre.value);
    const double front_share = known.front_share.value_or(body.front_share);
    const double cg_to_front_m = known.wheelbase_m * (1 - front_share);
    const double sensor_m = known.sensor_behind_front_axle_m.value_or(dashboard_m);
    const double mount_sd = known.mount == SensorMount::fixed ? fixed_gain_sd : holder_gain_sd;
    const double place_sd = known.sensor_behind_front_axle_m ? 0 : unknown_place_gain_sd;
    const double share_sd = known.front_share ? stated_front_share_sd : front_share_sd;

    return {
        .name = std::move(name),
        .gain = 1,
        .one_axle_gain = one_axle_gain,
        .half_car = {.ms_kg = ms_kg,
                     .mu_kg = mu_kg,
                     .ks_n_per_m = ks,
                     .cs_ns_per_m = 2 * damping * std::sqrt(ks * quarter_kg),
                     .kt_n_per_m = tyre.value,
                     .is_kgm2 = ms_kg * square(roll_radius_over_track * 2 * body.half_track_m) / 2,
                     .l_m = body.half_track_m},
        .axles = Axles{.wheelbase_m = known.wheelbase_m,
                       .cg_to_front_m = cg_to_front_m,
                       .dynamic_index = 1,
                       // Springs go with the square of the frequency, dampers with itself; the
                       // model has one ratio for both.
                       .rear_ratio = (1 / front_share - 1) * std::pow(rear_over_front_hz, 1.5)},
        .imu = {.x_m = cg_to_front_m - sensor_m, .y_m = known.sensor_left_m},
        .uncertainty = {{"gain", std::hypot(mount_sd, place_sd)},
                        {"ms_kg", std::hypot(load_sd_kg, wheels * mu_kg * unsprung_sd) / ms_kg},
                        {"mu_kg", unsprung_sd},
                        {"ks_n_per_m", 2 * bounce_sd},
                        {"cs_ns_per_m", std::hypot(damping_sd / damping, bounce_sd)},
                        {"kt_n_per_m", tyre.sd},
                        {"is_kgm2", roll_inertia_sd},
                        {"l_m", half_track_sd},
                        {"cg_to_front_m", share_sd / (1 - front_share)},
                        {"dynamic_index", unstated_dynamic_index_sd},
                        {"rear_ratio", rear_ratio_sd}}};
}

Vehicle with_usual_lowpass(Vehicle vehicle, double rate_hz) {
    if (vehicle.imu.lowpass_hz == 0) {
        vehicle.imu.lowpass_hz = usual_lowpass_over_rate * rate_hz;
    }
    return vehicle;
}

} // namespace macadam
