#include "mapping/fusion/trip_limit.hpp"

#include "mapping/fusion/utc_month.hpp"

#include <limits>

namespace macadam {
namespace {

/// Begin of the month of a pass; a number of its own if it is undated.
std::int64_t month_of(const std::optional<std::int64_t>& utc_ms) {
    return utc_ms ? month_begin_ms(*utc_ms) : std::numeric_limits<std::int64_t>::min();
}

} // namespace

bool TripLimit::admits(const FusionInput& pass) {
    if (!is_limited() || pass.reference || pass.vehicle == unknown_vehicle_) {
        return true;
    }
    auto& trips = trips_[{pass.vehicle, month_of(pass.utc_ms)}];
    if (trips.count == 0 || trips.last_sha256 != pass.trip_sha256) {
        ++trips.count;
        trips.last_sha256 = pass.trip_sha256;
    }
    return trips.count <= max_trips_;
}

} // namespace macadam
