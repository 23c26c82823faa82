#pragma once

namespace macadam {

/// Interval of a trip's time, from_s < to_s.
struct TimeSpan {
    double from_s;
    double to_s;
};

/// Interval of a trip's travel, from_m < to_m.
struct TravelSpan {
    double from_m;
    double to_m;
};

} // namespace macadam
