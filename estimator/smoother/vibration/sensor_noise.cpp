#include "estimator/smoother/vibration/sensor_noise.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr std::size_t min_windows = 12; // half a minute
constexpr int steps = 30;               // of Gauss-Newton

// Standard deviations of logarithms. Spectra of roads differ in shape from window to window;
// neighbouring windows share half of their samples.
constexpr double shape_sd = 0.4;
constexpr double overlap = 0.5;      // weight of a window
constexpr double stated_sd = 1;      // of the noise's power
constexpr double usual_by_speed = 1; // power of the speed with which the road's part grows
constexpr double by_speed_sd = 1;

// Road-caused power at 16 to 20 Hz over that at 7 to 13 Hz: 0.05 to 0.3 in simulated cars at 45 to
// 95 km/h.
constexpr double usual_log_ratio = -2.1;
constexpr double log_ratio_sd = 0.7;

/// Unknowns: logarithms of the noise's power and of the road's part at the mean speed, and its
/// growth with the speed.
using Unknowns = Eigen::Vector3d;

struct Fit {
    Unknowns step;
    double misfit;
};

/// Returns the Gauss-Newton step from a point, and the misfit there.
Fit fit_at(const Unknowns& at,
           const std::vector<VibrationSpectra::Window>& windows,
           double mean_log_speed,
           double log_stated) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    double misfit = 0;
    const auto observe = [&](const Unknowns& slope, double off, double weight) {
        information += weight * slope * slope.transpose();
        gradient += weight * off * slope;
        misfit += weight * off * off;
    };
    observe(Unknowns::UnitX(), log_stated - at[0], 1 / (stated_sd * stated_sd));
    observe(Unknowns::UnitY(), usual_log_ratio - at[1], 1 / (log_ratio_sd * log_ratio_sd));
    observe(Unknowns::UnitZ(), usual_by_speed - at[2], 1 / (by_speed_sd * by_speed_sd));
    for (const auto& window : windows) {
        const double faster = window.log_speed - mean_log_speed;
        const double noise = std::exp(at[0]);
        const double road = std::exp(at[1] + at[2] * faster) * window.low;
        const double share = road / (noise + road);
        const double variance = 1 / window.looks + std::pow(share * shape_sd, 2);
        // The logarithm of a mean of n squares lies 1/n below that of its expectation.
        const double off = std::log(window.high / (noise + road)) + 1 / window.looks;
        observe({1 - share, share, share * faster}, off, overlap / variance);
    }
    return {information.ldlt().solve(gradient), misfit};
}

} // namespace

double sensor_noise_mps2(const VibrationSpectra& spectra, double stated_mps2) {
    std::vector<VibrationSpectra::Window> windows;
    double log_speed = 0;
    for (const auto& window : spectra.windows) {
        if (window.high > 0 && window.low > 0) {
            windows.push_back(window);
            log_speed += window.log_speed;
        }
    }
    if (windows.size() < min_windows || !(stated_mps2 > 0)) {
        return stated_mps2;
    }
    const auto count = static_cast<double>(windows.size());
    const double log_stated = 2 * std::log(stated_mps2);
    Unknowns at{log_stated, usual_log_ratio, usual_by_speed};
    auto fit = fit_at(at, windows, log_speed / count, log_stated);
    for (int i = 0; i < steps; ++i) {
        Unknowns by = fit.step;
        by = by.cwiseMin(1).cwiseMax(-1);
        auto next = fit_at(at + by, windows, log_speed / count, log_stated);
        for (int halved = 0; halved < 6 && !(next.misfit < fit.misfit); ++halved) {
            by /= 2;
            next = fit_at(at + by, windows, log_speed / count, log_stated);
        }
        if (!(next.misfit < fit.misfit)) {
            break;
        }
        at += by;
        fit = next;
    }
    return std::max(stated_mps2, stated_mps2 * std::exp((at[0] - log_stated) / 2));
}

} // namespace macadam
