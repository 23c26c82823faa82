#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace macadam {

/// Base of the moving mean that shows localised roughness: 25 ft, as AASHTO R 54 and ProVAL's short
/// continuous report have it.
inline constexpr double localised_base_m = 7.62;

/// Mean of the last `count` values, for values that come one by one.
class MovingMean {
public:
    /// \param count  >= 1; need not be whole: of the oldest value then only a part counts.
    explicit MovingMean(double count);

    /// Nothing before as many values have come.
    std::optional<double> push(double value);

private:
    double count_;
    std::vector<double> last_;
    std::size_t pushed_ = 0;
    double sum_ = 0;
};

/// Where a moving mean stays above a threshold.
struct RoughPlace {
    double from_m; ///< middle of the first base that is too rough
    double to_m;   ///< and of the last
    double peak;   ///< the greatest mean between, in the unit of the values
    double peak_at_m;
};

/// Finds rough places in values that come one by one.
class RoughPlaces {
public:
    explicit RoughPlaces(double threshold) : threshold_{threshold} {}

    /// \param at_m  rising. \returns the place that ended before it, if one did.
    std::optional<RoughPlace> push(double at_m, double value);

    /// The place that lasts until the end, if one does.
    std::optional<RoughPlace> finish();

private:
    double threshold_;
    std::optional<RoughPlace> place_;
};

} // namespace macadam
