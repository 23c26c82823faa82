#include "estimator/smoother/car/linear_car.hpp"

#include "estimator/common/gravity.hpp"

namespace macadam {
namespace {

// Positions of the coordinates among the states; each is followed by its rate.
constexpr int heave = 0;
constexpr int pitch = 2;
constexpr int front_mean = 4;
constexpr int rear_mean = 6;
constexpr int roll = 8;
constexpr int front_half = 10;
constexpr int rear_half = 12;

/// Force as a row over the states.
using Row = LinearCar::Row;

/// Returns the force of spring and damper between a wheel and the body above it.
Row suspension(double ks_n_per_m, double cs_ns_per_m, const Row& stroke) {
    Row force = ks_n_per_m * stroke;
    for (int i = 0; i < LinearCar::states; i += 2) {
        force[i + 1] += cs_ns_per_m * stroke[i];
    }
    return force;
}

Row unit(int state) {
    return Row::Unit(state);
}

} // namespace

LinearCar linear_car(const Vehicle& vehicle) {
    const HalfCar& half = vehicle.half_car;
    const bool one_axle = !vehicle.axles;
    const Axles axles = vehicle.axles.value_or(Axles{.wheelbase_m = 0, .cg_to_front_m = 0});
    const double ahead_m = axles.cg_to_front_m;
    const double behind_m = axles.wheelbase_m - ahead_m;
    const double front_share = 2 / (1 + axles.rear_ratio);
    const double rear_share = axles.rear_ratio * front_share;
    const double bar = half.antiroll_n_per_m;

    const Row front_force = suspension(front_share * half.ks_n_per_m,
                                       front_share * half.cs_ns_per_m,
                                       unit(front_mean) - unit(heave) + ahead_m * unit(pitch));
    const Row rear_force = suspension(rear_share * half.ks_n_per_m,
                                      rear_share * half.cs_ns_per_m,
                                      unit(rear_mean) - unit(heave) - behind_m * unit(pitch));
    const Row front_stroke = unit(front_half) - half.l_m * unit(roll);
    const Row rear_stroke = unit(rear_half) - half.l_m * unit(roll);
    const Row front_pair =
        suspension(front_share * half.ks_n_per_m, front_share * half.cs_ns_per_m, front_stroke) +
        bar * front_stroke;
    const Row rear_pair =
        suspension(rear_share * half.ks_n_per_m, rear_share * half.cs_ns_per_m, rear_stroke) +
        bar * rear_stroke;

    LinearCar car{.a = decltype(LinearCar::a)::Zero(),
                  .b = decltype(LinearCar::b)::Zero(),
                  .felt = {},
                  .lean = decltype(LinearCar::lean)::Zero(),
                  .front_m = ahead_m,
                  .rear_m = -behind_m};
    for (int i = 0; i < LinearCar::states; i += 2) {
        car.a(i, i + 1) = 1;
    }
    const double tyre = half.kt_n_per_m / half.mu_kg;
    const auto wheel = [&](int state, const Row& force, int input) {
        car.a.row(state + 1) = -force / half.mu_kg - tyre * unit(state);
        car.b(state + 1, input) = tyre;
    };
    car.a.row(heave + 1) =
        2 * (one_axle ? Row{2 * front_force} : Row{front_force + rear_force}) / half.ms_kg;
    if (!one_axle) {
        const double pitch_kgm2 = axles.dynamic_index * half.ms_kg * ahead_m * behind_m;
        car.a.row(pitch + 1) = 2 * (behind_m * rear_force - ahead_m * front_force) / pitch_kgm2;
        car.lean(pitch + 1, 0) = half.ms_kg / pitch_kgm2;
    }
    car.a.row(roll + 1) =
        half.l_m * (one_axle ? Row{2 * front_pair} : Row{front_pair + rear_pair}) / half.is_kgm2;
    car.lean(roll + 1, 1) = half.ms_kg / (2 * half.is_kgm2);
    wheel(front_mean, front_force, 0);
    wheel(rear_mean, rear_force, 1);
    wheel(front_half, front_pair, 2);
    wheel(rear_half, rear_pair, 3);

    const ImuMount& imu = vehicle.imu;
    car.felt[0] =
        car.a.row(heave + 1) - imu.x_m * car.a.row(pitch + 1) + imu.y_m * car.a.row(roll + 1);
    car.felt[1] =
        -imu.height_above_roll_axis_m * car.a.row(roll + 1) + standard_gravity_mps2 * unit(roll);
    car.felt[2] = unit(roll + 1);
    car.felt[3] = unit(pitch + 1);
    return car;
}

} // namespace macadam
