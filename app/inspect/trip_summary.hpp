#pragma once

#include "estimator/common/geo.hpp"
#include "estimator/common/trip.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Readings of one sensor over a trip.
struct SensorSummary {
    std::size_t readings = 0;
    double rate_hz = 0;   ///< of the median step; 0: fewer than two readings
    std::size_t gaps = 0; ///< steps of more than 1 s and five times the median
    double longest_gap_s = 0;
};

/// Contents and quality of a trip log.
struct TripSummary {
    std::size_t rows = 0;
    std::size_t unusable_rows = 0; ///< damaged, or without a reading
    double duration_s = 0;
    std::optional<double> t0_utc_s{};
    SensorSummary acceleration{};
    SensorSummary rates{};
    SensorSummary speed{}; ///< of the wheels or the CAN bus
    SensorSummary positions{};
    double min_speed_mps = 0; ///< of the wheels, else of the receiver; NaN: unknown
    double max_speed_mps = 0;
    bool has_gnss_speed = false;
    bool has_course = false;
    std::optional<GeoPoint> first_at{}; ///< first position
    double accuracy_share = 0;          ///< of the positions with a stated accuracy
    double median_accuracy_m = 0;       ///< NaN: not stated
    std::size_t jumps = 0;              ///< steps between positions faster than 70 m/s
    double gravity_mps2 = 0;            ///< 0: not in the readings
    bool gravity_stated = false;        ///< as included
    double tilt_deg = 0;
    bool mounting_is_estimated = false;
    std::optional<double> distance_m{}; ///< `std::nullopt`: neither speeds nor two positions
    bool gives_roughness = false;
    bool gives_roads = false;            ///< can be matched to a map
    std::vector<std::string> missing{};  ///< what would let more be estimated, in words
    std::vector<std::string> warnings{}; ///< as an import gives them
};

/// Summarises a trip that was read with all its sensors.
TripSummary summarise(TripLog trip);

} // namespace macadam
