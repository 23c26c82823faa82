#pragma once

#include "mapping/fusion/fusion.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace macadam {

/// Limits how many trips of one car are fused over a segment in a month (UTC), so that the cost of
/// fusion does not grow with cars that drive the same road every day: those with the lowest hashes
/// are, which is a choice that depends neither on the order of import nor on what is read. A trip
/// that is deleted gives its place to the next one. Undated passes of a car count as one month.
/// Surveys are not limited, nor trips of unknown cars, which may be many cars.
class TripLimit {
public:
    /// \param max_trips  of a car, segment and month; 0: unlimited.
    /// \param unknown_vehicle  of trips whose car is not known, if there are any
    explicit TripLimit(std::int64_t max_trips, std::optional<std::int64_t> unknown_vehicle = {})
        : max_trips_{max_trips}, unknown_vehicle_{unknown_vehicle} {}

    bool is_limited() const { return max_trips_ > 0; }

    /// Begins with the passes of another segment.
    void begin_segment() { trips_.clear(); }

    /// Tests whether a pass is fused. Passes of a segment come in the order that FusionInput
    /// states.
    bool admits(const FusionInput& pass);

private:
    struct Trips {
        std::int64_t count = 0;
        std::string last_sha256;
    };
    std::int64_t max_trips_;
    std::optional<std::int64_t> unknown_vehicle_;
    std::map<std::pair<std::int64_t, std::int64_t>, Trips> trips_; ///< by vehicle and month
};

} // namespace macadam
