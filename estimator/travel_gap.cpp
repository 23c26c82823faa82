#include "estimator/travel_gap.hpp"

#include <algorithm>

namespace macadam {

double past_gap_m(const Odometer& odometer, double from_m, double to_m) {
    const auto& travel_m = odometer.knots().travel_m;
    const auto after = std::ranges::upper_bound(travel_m, from_m);
    if (after == travel_m.begin() || after == travel_m.end()) {
        return from_m;
    }
    return *after - *(after - 1) > longest_unseen_m && to_m < *after ? *after : from_m;
}

} // namespace macadam
