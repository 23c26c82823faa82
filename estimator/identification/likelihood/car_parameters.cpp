#include "estimator/identification/likelihood/car_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace macadam {
namespace {

constexpr double usual_rebound_excess = 0.3;
constexpr double max_rebound_excess = 0.9;

// A contact of 0.12 m smooths as 0.12 / sqrt(24) = 0.024 m.
constexpr double usual_smoothing_m = 0.03;

// A tenth to a third of the usual stroke rates.
constexpr double usual_slip_mps = 0.015;

// The centre of gravity of a car is 0.5 to 0.6 m above the ground, its roll axis some 0.1 m; the
// suspension's anti-dive raises the pitch axis (T. D. Gillespie, "Fundamentals of Vehicle
// Dynamics", SAE 1992, chapters 6 and 7).
constexpr double usual_pitch_arm_m = 0.35;
constexpr double usual_roll_arm_m = 0.45;

// Error of fits to simulated cars whose tyres, lanes and friction are not the model's
// (docs/method/identification.md).
constexpr double model_sd = 0.015;
constexpr double ratio_model_sd = 0.003; // of gain, dynamic index and the ratio of the axles
constexpr double roll_model_sd = 0.03;   // the tracks of the wheels are not those of the profile
constexpr double friction_model_sd = 0.1;

template <double HalfCar::*field>
double& of_half_car(FittedCar& car) {
    return car.vehicle.half_car.*field;
}

template <double Axles::*field>
double& of_axles(FittedCar& car) {
    return (*car.vehicle.axles).*field;
}

template <double FittedCar::*field>
double& beside_file(FittedCar& car) {
    return car.*field;
}

double& gain(FittedCar& car) {
    return car.vehicle.gain;
}

double& friction(FittedCar& car) {
    return *car.vehicle.half_car.friction_n;
}

/// Parameter whose prior_sd applies where the vehicle file states none; 0: held there.
struct Field {
    CarParameter parameter;
    bool of_roll;
};

constexpr bool in_file = true;
constexpr bool logarithmic = true;
constexpr bool of_roll = true;

constexpr Field fields[] = {
    {{"ms_kg", of_half_car<&HalfCar::ms_kg>, in_file, logarithmic, 0, 0}, !of_roll},
    {{"mu_kg", of_half_car<&HalfCar::mu_kg>, in_file, logarithmic, 0.2, model_sd}, !of_roll},
    {{"ks_n_per_m", of_half_car<&HalfCar::ks_n_per_m>, in_file, logarithmic, 0.25, model_sd},
     !of_roll},
    {{"cs_ns_per_m", of_half_car<&HalfCar::cs_ns_per_m>, in_file, logarithmic, 0.3, model_sd},
     !of_roll},
    {{"kt_n_per_m", of_half_car<&HalfCar::kt_n_per_m>, in_file, logarithmic, 0.15, model_sd},
     !of_roll},
    {{"friction_n", friction, in_file, logarithmic, 0.7, friction_model_sd}, !of_roll},
    {{"dynamic_index",
      of_axles<&Axles::dynamic_index>,
      in_file,
      logarithmic,
      unstated_dynamic_index_sd,
      ratio_model_sd},
     !of_roll},
    {{"rear_ratio", of_axles<&Axles::rear_ratio>, in_file, logarithmic, 0.15, ratio_model_sd},
     !of_roll},
    {{"cg_to_front_m", of_axles<&Axles::cg_to_front_m>, in_file, logarithmic, 0, ratio_model_sd},
     !of_roll},
    {{"gain", gain, in_file, logarithmic, 0.1, ratio_model_sd}, !of_roll},
    {{"is_kgm2", of_half_car<&HalfCar::is_kgm2>, in_file, logarithmic, 0.3, roll_model_sd},
     of_roll},
    {{"antiroll_n_per_m",
      of_half_car<&HalfCar::antiroll_n_per_m>,
      in_file,
      logarithmic,
      0.5,
      roll_model_sd},
     of_roll},
    {{"l_m", of_half_car<&HalfCar::l_m>, in_file, logarithmic, 0, roll_model_sd}, of_roll},
    {{"rebound_excess", beside_file<&FittedCar::rebound_excess>, !in_file, !logarithmic, 0.3, 0},
     !of_roll},
    {{"smoothing_m", beside_file<&FittedCar::smoothing_m>, !in_file, logarithmic, 0.7, 0},
     !of_roll},
    {{"slip_mps", beside_file<&FittedCar::slip_mps>, !in_file, logarithmic, 0.6, 0}, !of_roll},
    {{"pitch_arm_m", beside_file<&FittedCar::pitch_arm_m>, !in_file, !logarithmic, 0.15, 0},
     !of_roll},
    {{"roll_arm_m", beside_file<&FittedCar::roll_arm_m>, !in_file, !logarithmic, 0.1, 0}, of_roll},
};

/// Returns the prior standard deviation of a field: the stated one, else the usual one.
double prior_sd_of(const Field& field, const Vehicle& vehicle) {
    const auto stated = vehicle.uncertainty.find(std::string{field.parameter.name});
    if (stated != vehicle.uncertainty.end()) {
        return stated->second;
    }
    const bool is_friction = field.parameter.name == "friction_n";
    return is_friction && vehicle.half_car.friction_n ? 0 : field.parameter.prior_sd;
}

bool is_among(const std::vector<CarParameter>& parameters, std::string_view name) {
    return std::ranges::find(parameters, name, &CarParameter::name) != parameters.end();
}

} // namespace

FittedCar expected_car(const Vehicle& vehicle) {
    FittedCar car{.vehicle = vehicle,
                  .rebound_excess = usual_rebound_excess,
                  .smoothing_m = usual_smoothing_m,
                  .slip_mps = usual_slip_mps,
                  .pitch_arm_m = usual_pitch_arm_m,
                  .roll_arm_m = usual_roll_arm_m};
    auto& half_car = car.vehicle.half_car;
    half_car.friction_n = half_car.friction_n.value_or(usual_friction_n(half_car).mean);
    return car;
}

std::vector<CarParameter> parameters_of(const Vehicle& vehicle, bool rolls) {
    std::vector<CarParameter> parameters;
    auto car = expected_car(vehicle);
    for (const auto& field : fields) {
        auto parameter = field.parameter;
        parameter.prior_sd = prior_sd_of(field, vehicle);
        if (parameter.prior_sd > 0 && parameter.in(car) > 0 && (rolls || !field.of_roll)) {
            parameters.push_back(parameter);
        }
    }
    return parameters;
}

FittedCar
moved(FittedCar car, const std::vector<CarParameter>& parameters, const Eigen::VectorXd& by) {
    auto& half_car = car.vehicle.half_car;
    const double mass_kg = half_car.ms_kg;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        double& value = parameters[i].in(car);
        const double move = by[static_cast<Eigen::Index>(i)];
        value = parameters[i].logarithmic ? value * std::exp(move) : value + move;
    }
    const double by_mass = half_car.ms_kg / mass_kg;
    half_car.is_kgm2 *= is_among(parameters, "is_kgm2") ? 1 : by_mass;
    half_car.antiroll_n_per_m *= is_among(parameters, "antiroll_n_per_m") ? 1 : by_mass;
    car.rebound_excess = std::clamp(car.rebound_excess, -max_rebound_excess, max_rebound_excess);
    auto& axles = *car.vehicle.axles;
    axles.cg_to_front_m = std::min(axles.cg_to_front_m, 0.95 * axles.wheelbase_m);
    return car;
}

} // namespace macadam
