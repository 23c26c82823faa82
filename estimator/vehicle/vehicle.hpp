#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace macadam {

/// Parameters of the paper's lateral half-car: one axle, two wheels. The quarter car is a quarter
/// of it.
struct HalfCar {
    double ms_kg;                ///< sprung mass of the whole car
    double mu_kg;                ///< unsprung mass, per wheel
    double ks_n_per_m;           ///< suspension stiffness, per wheel
    double cs_ns_per_m;          ///< suspension damping, per wheel
    double kt_n_per_m;           ///< tyre stiffness, per wheel
    double is_kgm2;              ///< roll inertia of half the body (the paper's I_s)
    double l_m;                  ///< half the track width
    double antiroll_n_per_m = 0; ///< anti-roll bar, at each wheel in roll

    /// Dry friction of each suspension. `std::nullopt`: not known.
    std::optional<double> friction_n = std::nullopt;
};

/// Value that a vehicle file does not state, and its standard deviation.
struct UsualValue {
    double mean;
    double sd;
};

/// Sprung mass of a middle-sized passenger car.
inline constexpr double usual_mass_kg = 1400;

/// Returns the dry friction of each suspension, in newtons, where the file is silent: from none to
/// 50 N, evenly, for usual_mass_kg, and in proportion to the mass
/// (docs/decisions/42-friction-has-a-prior.md).
UsualValue usual_friction_n(const HalfCar& car);

struct Axles {
    double wheelbase_m;
    double cg_to_front_m;
    double dynamic_index = 1; ///< k^2 / (a b); 1: the two ends are decoupled
    double rear_ratio = 1;    ///< rear over front, for ks and cs
};

/// Relative standard deviation of a dynamic index that a vehicle file does not state. Few are
/// published. The ends of a car move nearly independently by design (T. D. Gillespie, "Fundamentals
/// of Vehicle Dynamics", SAE 1992, chapter 5), hence about 1.
inline constexpr double unstated_dynamic_index_sd = 0.08;

/// Position of the inertial sensor relative to the centre of gravity, and its signal properties.
struct ImuMount {
    double x_m = 0;                      ///< ahead
    double y_m = 0;                      ///< to the left
    double height_above_roll_axis_m = 0; ///< 0: not known
    double lowpass_hz = 0;               ///< 0: not known; no_lowpass_hz: none
    int lowpass_order = 2;
    double noise_mps2 = 0.05;
    double noise_radps = 0.002;
};

struct Vehicle {
    std::string name;
    double gain = 1; ///< measured = gain * modelled, every accelerometer channel (the paper's mu)

    /// Gain for a method that models only one axle of a car with two. The sensor of such a car
    /// measures the mean of both ends, filtered by the wheelbase: about 0.72
    /// (docs/method/identification.md). `std::nullopt`: as `gain`.
    std::optional<double> one_axle_gain;

    HalfCar half_car;
    std::optional<Axles> axles; ///< `std::nullopt`: one axle, under the centre of gravity
    ImuMount imu;
    std::map<std::string, double> uncertainty; ///< relative sd, by field name
};

/// Returns the divisor that a one-axle method applies to the vehicle's measurements.
double gain_for_one_axle(const Vehicle& vehicle);

/// Returns `golden-car`, `audi-a6-etron` (the paper's, table III), `generic` and wide classes of
/// cars.
std::span<const Vehicle> built_in_vehicles();

/// Returns the built-in vehicle, or a null pointer if no vehicle has that name.
const Vehicle* built_in_vehicle(std::string_view name);

} // namespace macadam
