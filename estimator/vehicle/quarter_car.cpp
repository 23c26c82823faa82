#include "estimator/vehicle/quarter_car.hpp"

namespace macadam {
namespace {

/// Parameters divided by the sprung mass on the wheel.
struct PerSprungMass {
    double suspension_per_s2;
    double damping_per_s;
    double tyre_per_s2;
    double unsprung_ratio;
};

QuarterCar motion(const PerSprungMass& car) {
    const auto [ks, cs, kt, mu] = car;
    QuarterCar system;
    system.a << 0, 1, 0, 0, //
        -ks, -cs, ks, cs,   //
        0, 0, 0, 1,         //
        ks / mu, cs / mu, -(ks + kt) / mu, -cs / mu;
    system.b << 0, 0, 0, kt / mu;
    system.c = system.a.row(1);
    return system;
}

} // namespace

QuarterCar quarter_car(const HalfCar& car) {
    const double quarter_kg = car.ms_kg / 4;
    return motion({.suspension_per_s2 = car.ks_n_per_m / quarter_kg,
                   .damping_per_s = car.cs_ns_per_m / quarter_kg,
                   .tyre_per_s2 = car.kt_n_per_m / quarter_kg,
                   .unsprung_ratio = car.mu_kg / quarter_kg});
}

QuarterCar golden_car() {
    auto car = motion({.suspension_per_s2 = 63.3,
                       .damping_per_s = 6,
                       .tyre_per_s2 = 653,
                       .unsprung_ratio = 0.15});
    car.c << 1, 0, -1, 0;
    return car;
}

} // namespace macadam
