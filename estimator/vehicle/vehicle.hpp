#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace macadam {

/// The paper's lateral half-car: one axle, two wheels. The quarter car is a quarter of it.
struct HalfCar {
    double ms_kg;                ///< whole sprung mass of the car
    double mu_kg;                ///< unsprung mass, per wheel
    double ks_n_per_m;           ///< suspension stiffness, per wheel
    double cs_ns_per_m;          ///< suspension damping, per wheel
    double kt_n_per_m;           ///< tyre stiffness, per wheel
    double is_kgm2;              ///< roll inertia of half the body (the paper's I_s)
    double l_m;                  ///< half the track width
    double antiroll_n_per_m = 0; ///< of a bar, at each wheel as the body rolls

    /// Dry, of each suspension. Nothing: not known.
    std::optional<double> friction_n = std::nullopt;
};

struct Axles {
    double wheelbase_m;
    double cg_to_front_m;
    double dynamic_index = 1; ///< k^2 / (a b), 1: the two ends move on their own
    double rear_ratio = 1;    ///< rear over front, of ks and cs
};

/// Where the inertial sensor sits, from the centre of gravity, and what it does to the signal.
struct ImuMount {
    double x_m = 0;                      ///< ahead
    double y_m = 0;                      ///< to the left
    double height_above_roll_axis_m = 0; ///< 0: not known
    double lowpass_hz = 0;               ///< 0: none
    int lowpass_order = 2;
    double noise_mps2 = 0.05;
    double noise_radps = 0.002;
};

struct Vehicle {
    std::string name;
    double gain = 1; ///< measured = gain * modelled, every accelerometer channel (the paper's mu)

    /// The same for a method that sees only one axle of a car with two. Its sensor feels the mean
    /// of both ends, which the wheelbase combs: about 0.72 (docs/method/identification.md).
    /// Nothing: as `gain`.
    std::optional<double> one_axle_gain;

    HalfCar half_car;
    std::optional<Axles> axles; ///< nothing: one axle, under the centre of gravity
    ImuMount imu;
    std::map<std::string, double> uncertainty; ///< relative sd, by the names of the fields above
};

/// What a one-axle method divides the vehicle's measurements by.
double gain_for_one_axle(const Vehicle& vehicle);

/// `golden-car`, `audi-a6-etron` (the paper's, table III), `generic` and wide classes of cars.
std::span<const Vehicle> built_in_vehicles();

/// Null if there is none of that name.
const Vehicle* built_in_vehicle(std::string_view name);

} // namespace macadam
