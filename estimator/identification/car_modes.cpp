#include "estimator/identification/car_modes.hpp"

#include "estimator/vehicle/quarter_car.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <complex>
#include <numbers>

namespace macadam {

CarModes modes_of(const HalfCar& car) {
    const Eigen::Vector4cd poles = quarter_car(car).a.eigenvalues();
    std::array<std::complex<double>, 4> sorted{poles[0], poles[1], poles[2], poles[3]};
    std::ranges::sort(sorted, {}, [](const auto& pole) { return std::abs(pole); });
    const auto& bounce = sorted[0];
    const auto& hop = sorted[2];
    return {.bounce_hz = std::abs(bounce) / (2 * std::numbers::pi),
            .bounce_damping = -bounce.real() / std::abs(bounce),
            .hop_hz = std::abs(hop) / (2 * std::numbers::pi)};
}

} // namespace macadam
