#include "mapping/fusion/trip_limit.hpp"

#include <chrono>
#include <limits>

namespace macadam {
namespace {

/// Months since the year 0; a number of its own for undated passes.
std::int64_t month_of(const std::optional<std::int64_t>& utc_ms) {
    using namespace std::chrono;
    if (!utc_ms) {
        return std::numeric_limits<std::int64_t>::min();
    }
    const year_month_day day{floor<days>(sys_time<milliseconds>{milliseconds{*utc_ms}})};
    return 12 * std::int64_t{int{day.year()}} + unsigned{day.month()};
}

} // namespace

bool TripLimit::admits(const FusionInput& pass) {
    if (!is_limited() || pass.reference) {
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
