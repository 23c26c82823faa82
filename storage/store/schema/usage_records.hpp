#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace macadam {

/// What the trips of one car gave, read with one vehicle model by one method.
struct VehicleUse {
    std::string vehicle; ///< pseudonym
    std::string vehicle_model;
    std::string method;
    std::size_t trips = 0;
    std::size_t undated_trips = 0;
    std::size_t passes = 0;
    double km = 0; ///< driven
    double matched_km = 0;
    std::size_t rows_read = 0;
    std::size_t rows_used = 0;
};

/// A reference survey that the store holds.
struct SurveyUse {
    std::string name;
    std::string file_name;
    std::string sha256;
    std::optional<std::int64_t> utc_ms; ///< the day on which it was measured
    double relative_sd = 0;             ///< its stated accuracy
    double row_m = 0;                   ///< the median length of its rows
    std::size_t rows_read = 0;
    std::size_t rows_used = 0;
    std::size_t passes = 0; ///< of segments
    double km = 0;          ///< of these segments
    double alone_km = 0;    ///< of them, without a pass of any car
};

struct ClassLength {
    std::string name;
    double km;
};

/// Driven road of one class of OpenStreetMap in one class of roughness.
struct RoadClassLength {
    std::string highway; ///< "" where the map has none
    std::string class_name;
    double km;
};

/// What trips that began on one day, UTC, brought.
struct DailyUsage {
    std::string day; ///< "2026-03-01"
    std::size_t trips;
    std::size_t passes;
};

/// When the road was seen: the first and the last dated pass of all; nothing if none is dated.
struct ObservedPeriod {
    std::optional<std::int64_t> first_ms;
    std::optional<std::int64_t> last_ms;
};

} // namespace macadam
