#include "estimator/vehicle/half_car.hpp"

namespace macadam {

LinearSystem<8, 2, 2> half_car(const HalfCar& car, double height_above_roll_axis_m) {
    const double half_kg = car.ms_kg / 2;
    const double l = car.l_m;
    using Row = Eigen::RowVector<double, 8>;

    // Forces of the left and the right suspension on their wheels, upward; the body gets the
    // opposite.
    Row left, right;
    left << car.ks_n_per_m, car.cs_ns_per_m, -car.ks_n_per_m * l, -car.cs_ns_per_m * l,
        -car.ks_n_per_m, -car.cs_ns_per_m, 0, 0;
    right << car.ks_n_per_m, car.cs_ns_per_m, car.ks_n_per_m * l, car.cs_ns_per_m * l, 0, 0,
        -car.ks_n_per_m, -car.cs_ns_per_m;
    const auto unit = [](int i) { return Row{Row::Unit(i)}; };

    LinearSystem<8, 2, 2> system;
    system.a.row(0) = unit(1);
    system.a.row(1) = -(left + right) / half_kg;
    system.a.row(2) = unit(3);
    system.a.row(3) = l * (left - right) / car.is_kgm2;
    system.a.row(4) = unit(5);
    system.a.row(5) = (left - car.kt_n_per_m * unit(4)) / car.mu_kg;
    system.a.row(6) = unit(7);
    system.a.row(7) = (right - car.kt_n_per_m * unit(6)) / car.mu_kg;

    system.b.setZero();
    system.b(5, 0) = car.kt_n_per_m / car.mu_kg;
    system.b(7, 1) = car.kt_n_per_m / car.mu_kg;

    const double height_m = height_above_roll_axis_m > 0 ? height_above_roll_axis_m : 1;
    system.c.row(0) = system.a.row(1);
    system.c.row(1) = height_m * system.a.row(3);
    return system;
}

LinearSystem<8, 2, 1> lateral_half_car(const HalfCar& car, double height_above_roll_axis_m) {
    const auto both = half_car(car, height_above_roll_axis_m);
    return {both.a, both.b, both.c.row(1)};
}

} // namespace macadam
