#pragma once

#include "estimator/motion/heading.hpp"
#include "estimator/motion/stretch.hpp"
#include "estimator/roughness/roughness_trace.hpp"
#include "mapping/matching/map_match.hpp"
#include "mapping/passes/chunk_trace.hpp"
#include "mapping/passes/pass.hpp"
#include "mapping/privacy/trip_trimming.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

struct Mounting; // estimator/motion/mounting.hpp

struct PipelineConfig {
    OdometerConfig odometer;
    StretchConfig stretch;
    EstimatorConfig estimator;
    MatchConfig match;
    PassConfig pass;
    TrimRule trim; ///< what of a trip enters no pass
};

/// Roughness along one trip, and what it was made of.
struct TripTrace {
    Odometer odometer;
    Heading heading;
    IriTrace roughness;
    RowAudit use;
    std::vector<std::string> warnings;
};

/// The trip with the receiver's latency filled in where the log does not state it and its speeds
/// tell. Adds to `warnings` what was found, or that it could not be.
TripLog with_latency(TripLog trip, std::vector<std::string>& warnings);

/// \throws InputError  if the log lacks the vibration that is asked for.
void expect_channels(const TripLog& trip, const Mounting& mounting, Channels channels);

/// What to say of a log's rate, mounting, wheels and columns.
std::vector<std::string>
warnings_of(const TripLog& trip, const Odometer& odometer, const Mounting& mounting);

/// How far the antenna sits ahead of the centre of gravity. The log counts from the front axle,
/// which a car with one axle has under its centre of gravity.
double antenna_ahead_m(const TripMeta& meta, const Vehicle& vehicle);

/// The engine alone: what one trip says of the road along its own travel. No map.
TripTrace trace_of(const TripLog& trip, const Vehicle& vehicle, const PipelineConfig& config);

/// What one trip gives to the store, with every row of its log accounted for.
struct TripResult {
    std::vector<Pass> passes;             ///< their times count from begin_ms on
    std::vector<RoughnessTrace> traces{}; ///< what the passes were read from, metre by metre
    RowCount rows;
    std::optional<std::int64_t> begin_ms{0}; ///< of what is told, since the trip's t0; nothing: too
                                             ///< short to tell anything
    double distance_m = 0;                   ///< of what is told
    double matched_m = 0;                    ///< of it, on roads of the network
    std::vector<std::string> warnings;
};

/// The whole of the science: one trip in, its passes out. No files, no clock, no globals.
///
/// The trip is taken by value: its vibration is let go as soon as it has become roughness, so that
/// ten hours of it do not stand in memory while they are matched.
TripResult passes_of(TripLog trip,
                     const Vehicle& vehicle,
                     const RoadNetwork& roads,
                     const PipelineConfig& config);

} // namespace macadam
