#pragma once

#include "estimator/simulation/road_features.hpp"
#include "mapping/events/pass_event.hpp"
#include "mapping/passes/chunk_trace.hpp"
#include "mapping/passes/pass.hpp"

#include <cstdint>
#include <vector>

namespace macadam::testing {

/// One straight road and how it is driven.
struct ChunkScenario {
    double iri_mm_per_m;
    std::size_t passes;
    bool smoother; ///< else the published filter
    std::uint64_t seed;
    double patches_per_km = 3;
    double potholes_per_km = 0;
    double place_sd_m = 2;        ///< of where the match puts a trip, ...
    double place_length_m = 300;  ///< ... which changes over this distance
    double phones_place_sd_m = 0; ///< of every second trip, if not 0; then each match says its own
};

inline constexpr double straight_road_m = 2600;
inline constexpr double way_begins_m = 100; ///< of the road: there the cars have settled
inline constexpr double way_m = straight_road_m - 2 * way_begins_m;

/// One trip over it. Five cars take turns at 35 to 95 km/h, each with a vehicle file 5 % wrong and
/// an odometer 0.5 % wrong; they wander in their lane.
struct ChunkDrive {
    std::vector<PassEvent> events;
    double half_track_m;
    std::vector<double> aside_m; ///< of the car in its lane, at each metre of the road
    std::vector<RoughnessTrace> traces;
    std::vector<Pass> passes;
    std::vector<double> place_error_m; ///< of the match, at each metre of the road
};

struct TrueHole {
    double at_m; ///< along the way
    Pothole hole;

    /// Depth in the wheel path of a car in the middle of its lane.
    double depth_mm() const;

    /// Depth that the wheels of a drive met.
    double met_mm(const ChunkDrive& drive) const;
};

struct DrivenChunks {
    std::vector<TrueHole> holes; ///< in no order
    RoadNetwork roads;           ///< one way
    std::vector<ChunkDrive> drives;
    std::vector<double> true_mri; ///< of the segments, by index
};

DrivenChunks driven_chunks(const ChunkScenario& scenario);

} // namespace macadam::testing
