#include "estimator/vehicle/vehicle.hpp"

#include <algorithm>
#include <array>

namespace macadam {
namespace {

/// Gain of a car with two axles seen as a quarter car: its wheelbase filters the road with a comb
/// whose RMS is 1/sqrt(2) for a sensor at the middle; the paper identified 0.72 on its Audi, table
/// III.
constexpr double two_axle_gain = 0.72;

/// ASTM E1926 (K1 = 653, K2 = 63.3, C = 6 per second, mu = 0.15) on a body of 1000 kg, as in table
/// I of the paper. E1926 defines one wheel track only: width and roll inertia are chosen here, for
/// a body whose two sides are decoupled (I = m l^2 / 2).
Vehicle golden() {
    return {.name = "golden-car",
            .one_axle_gain = {},
            .half_car = {.ms_kg = 1000,
                         .mu_kg = 37.5,
                         .ks_n_per_m = 15825,
                         .cs_ns_per_m = 1500,
                         .kt_n_per_m = 163250,
                         .is_kgm2 = 281,
                         .l_m = 0.75,
                         .friction_n = 0},
            .axles = {},
            .imu = {},
            .uncertainty = {}};
}

/// Table III of the paper: masses and width approximated by its authors, the rest identified on 500
/// m of laser-measured road. The parameters were fitted jointly, so their errors largely cancel;
/// the remaining error is stated as one of the gain.
Vehicle audi_a6_etron() {
    return {.name = "audi-a6-etron",
            .gain = 0.72,
            .one_axle_gain = {},
            .half_car = {.ms_kg = 2400,
                         .mu_kg = 90,
                         .ks_n_per_m = 37050,
                         .cs_ns_per_m = 4290,
                         .kt_n_per_m = 370600,
                         .is_kgm2 = 1960,
                         .l_m = 1.0},
            .axles = {},
            .imu = {},
            .uncertainty = {{"gain", 0.04}}};
}

/// Builds a class of cars. Classes are not measurements of any car: body bounce is near 1.2 to 1.4
/// Hz with 0.25 to 0.35 of critical damping and wheel hop at 10 to 12.5 Hz, the ranges of textbooks
/// on ride for passenger cars, with masses of the class; the uncertainty spans the class.
Vehicle car_class(const char* name, const HalfCar& half_car) {
    return {.name = name,
            .gain = two_axle_gain,
            .one_axle_gain = {},
            .half_car = half_car,
            .axles = {},
            .imu = {},
            .uncertainty = {{"gain", 0.10},
                            {"ms_kg", 0.15},
                            {"mu_kg", 0.20},
                            {"ks_n_per_m", 0.25},
                            {"cs_ns_per_m", 0.30},
                            {"kt_n_per_m", 0.15},
                            {"is_kgm2", 0.30},
                            {"l_m", 0.05}}};
}

std::array<Vehicle, 6> make_built_in_vehicles() {
    return {golden(),
            audi_a6_etron(),
            car_class("generic", {1500, 42, 26000, 2000, 210000, 330, 0.77}),
            car_class("small-car", {1000, 34, 18000, 1350, 180000, 200, 0.72}),
            car_class("suv", {1900, 52, 33000, 2600, 250000, 460, 0.80}),
            car_class("van", {2300, 60, 42000, 3200, 290000, 640, 0.83})};
}

} // namespace

UsualValue usual_friction_n(const HalfCar& car) {
    const double size = car.ms_kg / usual_mass_kg;
    return {.mean = 25 * size, .sd = 15 * size};
}

double gain_for_one_axle(const Vehicle& vehicle) {
    return vehicle.one_axle_gain.value_or(vehicle.gain);
}

std::span<const Vehicle> built_in_vehicles() {
    static const auto vehicles = make_built_in_vehicles();
    return vehicles;
}

const Vehicle* built_in_vehicle(std::string_view name) {
    const auto vehicles = built_in_vehicles();
    const auto found = std::ranges::find(vehicles, name, &Vehicle::name);
    return found == vehicles.end() ? nullptr : &*found;
}

} // namespace macadam
