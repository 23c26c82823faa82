#include "estimator/smoother/car/discrete_car.hpp"

#include "estimator/vehicle/linear_system.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {

CarSteps car_steps(const LinearCar& car, double step_s) {
    constexpr int n = LinearCar::states;
    constexpr int m = LinearCar::inputs;
    constexpr int pulls = pull_count;
    const double part_s = step_s / CarSteps::parts;
    // The inputs, their slopes and the pulls are appended to the states: C. F. Van Loan, "Computing
    // integrals involving the matrix exponential", IEEE Transactions on Automatic Control 23
    // (1978), pp. 395-404.
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(n + 2 * m + pulls, n + 2 * m + pulls);
    whole.topLeftCorner(n, n) = car.a * part_s;
    whole.block(0, n, n, m) = car.b * part_s;
    whole.block(n, n + m, m, m).setIdentity();
    whole.block(0, n + 2 * m, n, pulls) = car.lean * part_s;
    const Eigen::MatrixXd moved = exponential(whole);
    const Eigen::MatrixXd phi = moved.topLeftCorner(n, n);
    const Eigen::MatrixXd at_end = moved.block(0, n + m, n, m);
    const Eigen::MatrixXd at_begin = moved.block(0, n, n, m) - at_end;
    const Eigen::MatrixXd lean = moved.block(0, n + 2 * m, n, pulls);

    CarSteps steps{.car = car,
                   .step_s = step_s,
                   .phi = decltype(CarSteps::phi)::Identity(),
                   .node = {},
                   .lean = decltype(CarSteps::lean)::Zero()};
    for (auto& columns : steps.node) {
        columns.setZero();
    }
    for (std::size_t part = CarSteps::parts; part-- > 0;) {
        steps.node[part + 1] += steps.phi * at_end;
        steps.node[part] += steps.phi * at_begin;
        steps.lean += steps.phi * lean;
        steps.phi = steps.phi * phi;
    }
    return steps;
}

RoadPush road_push(const CarSteps& steps, double travel_m, double run_m, double cell_m) {
    RoadPush push;
    for (std::size_t axle = 0; axle < 2; ++axle) {
        auto& to = push.axles[axle];
        const double from =
            (travel_m + (axle == 0 ? steps.car.front_m : steps.car.rear_m)) / cell_m;
        const double run = run_m / cell_m;
        to.first = static_cast<std::ptrdiff_t>(std::floor(from));
        for (std::size_t part = 0; part <= CarSteps::parts; ++part) {
            const double at = from + run * static_cast<double>(part) / CarSteps::parts;
            const auto below = static_cast<std::ptrdiff_t>(std::floor(at));
            const double share = at - static_cast<double>(below);
            for (std::size_t side = 0; side < 2; ++side) {
                const auto column = std::min(static_cast<std::size_t>(below - to.first) + side,
                                             RoadPush::max_cells - 1);
                const double weight = side == 0 ? 1 - share : share;
                to.cells = std::max(to.cells, column + 1);
                const auto heave = steps.node[part].col(static_cast<int>(axle));
                const auto roll = steps.node[part].col(static_cast<int>(axle) + 2);
                for (int i = 0; i < LinearCar::heave_states; ++i) {
                    to.heave[column][static_cast<std::size_t>(i)] += weight * heave[i];
                }
                for (int i = 0; i < LinearCar::roll_states; ++i) {
                    to.roll[column][static_cast<std::size_t>(i)] +=
                        weight * roll[LinearCar::heave_states + i];
                }
            }
        }
    }
    return push;
}

} // namespace macadam
