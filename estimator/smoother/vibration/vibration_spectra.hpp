#pragma once

#include "estimator/motion/stretch.hpp"

#include <array>
#include <map>
#include <vector>

namespace macadam {

/// Mean power spectra of a trip's vertical acceleration and pitch rate, by speed. What the road
/// causes moves along the frequencies with the speed; what car and mount cause remains.
struct VibrationSpectra {
    static constexpr double first_hz = 3;
    static constexpr double step_hz = 0.4;
    static constexpr std::size_t bins = 53;    ///< to 24 Hz
    static constexpr std::size_t channels = 2; ///< vertical, pitch
    using Power = std::array<double, bins>;

    /// Sums over windows of some 5 s with nearly one speed, each relative to its own level.
    struct AtSpeed {
        std::size_t windows = 0;
        double log_speed = 0;
        std::array<Power, channels> power{};
        std::array<double, channels> noise{}; ///< part of `power` that is white noise of variance 1
    };

    /// One window's vertical acceleration: mean power, as the variance of a reading of white noise
    /// of that power, (m/s^2)^2.
    struct Window {
        double log_speed;
        double low;   ///< around wheel hop
        double high;  ///< at the highest frequencies that are used
        double looks; ///< independent Fourier components in `high`
    };

    std::map<int, AtSpeed> speeds; ///< by class of speed, some 12 % wide
    std::vector<Window> windows;
    double pitch_noise_radps = 0; ///< the largest of the stretches
    std::size_t used_bins = bins; ///< those below the logs' own limit
    bool has_pitch = true;        ///< in all stretches
};

/// Adds a stretch that contains vertical acceleration. Others are ignored.
void add(VibrationSpectra& spectra, const Stretch& stretch);

/// Returns the mean over the windows of one over the strength of wheel hop, s^2/m.
double inverse_strength(const VibrationSpectra& spectra);

} // namespace macadam
