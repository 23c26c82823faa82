#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace macadam {

/// Base length of the moving mean for localised roughness: 25 ft, as in AASHTO R 54 and ProVAL's
/// short continuous report.
inline constexpr double localised_base_m = 7.62;

/// Moving mean of the last `count` values of a sequence.
class MovingMean {
public:
    /// \param count  >= 1; need not be whole: the oldest value then counts with the fractional
    ///               weight.
    explicit MovingMean(double count);

    /// Adds a value and returns the mean; `std::nullopt` until `count` values have been added.
    std::optional<double> push(double value);

private:
    double count_;
    std::vector<double> last_;
    std::size_t pushed_ = 0;
    double sum_ = 0;
};

/// Interval in which a moving mean stays above a threshold.
struct RoughInterval {
    double from_m; ///< centre of the first base above the threshold
    double to_m;   ///< centre of the last base above the threshold
    double peak;   ///< maximum mean, in the unit of the values
    double peak_at_m;
};

/// Finds localised roughness in a sequence of values.
class RoughIntervalFinder {
public:
    explicit RoughIntervalFinder(double threshold) : threshold_{threshold} {}

    /// \param at_m  increasing. \returns the rough interval that ended before at_m, if any.
    std::optional<RoughInterval> push(double at_m, double value);

    /// Returns the rough interval that lasts until the end, if any.
    std::optional<RoughInterval> finish();

private:
    double threshold_;
    std::optional<RoughInterval> interval_;
};

} // namespace macadam
