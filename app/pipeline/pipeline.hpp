#pragma once

#include "estimator/common/geo.hpp"
#include "estimator/common/progress.hpp"
#include "estimator/motion/heading.hpp"
#include "estimator/motion/stretch.hpp"
#include "estimator/roughness/roughness_trace.hpp"
#include "estimator/smoother/vibration/resonance.hpp"
#include "mapping/events/pass_event.hpp"
#include "mapping/matching/map_match.hpp"
#include "mapping/passes/chunk_trace.hpp"
#include "mapping/passes/pass.hpp"
#include "mapping/privacy/trip_trimming.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

struct TripMotion; // estimator/motion/trip_motion.hpp

struct PipelineConfig {
    OdometerConfig odometer;
    StretchConfig stretch;
    EstimatorConfig estimator;
    MatchConfig match;
    PassConfig pass;
    TrimRule trim; ///< parts of a trip excluded from passes
};

/// Roughness along one trip, with its intermediate results.
struct TripTrace {
    Odometer odometer;
    Heading heading;
    IriTrace roughness;
    RowAudit use;
    std::vector<std::string> warnings;
};

/// Returns the warning about a holder that resonates.
std::string holder_text(const Resonance& mount);

/// Returns the distance of the antenna ahead of the centre of gravity. The log counts from the
/// front axle; a car with one axle has it under its centre of gravity.
double antenna_ahead_m(const TripMeta& meta, const Vehicle& vehicle);

/// Estimates the roughness along the trip's own travel. Uses no map. Reports progress in
/// thousandths.
///
/// \throws InputError  if the log lacks a requested sensor, or sampled too slowly, or a stop is
///                     requested.
TripTrace trace_of(const TripLog& trip,
                   TripMotion motion,
                   const Vehicle& vehicle,
                   const PipelineConfig& config,
                   const Progress& progress = {});

/// Result of one trip for the database, with every row of its log accounted for.
struct TripResult {
    std::vector<Pass> passes;             ///< times relative to begin_ms
    std::vector<RoughnessTrace> traces{}; ///< source of the passes, metre by metre

    /// Events on the passes; `std::nullopt`: the method gives no elevations to search.
    std::optional<std::vector<PassEvent>> events{};
    RowCount rows;
    std::optional<std::int64_t> begin_ms{0}; ///< start of the reported part, since the trip's t0;
                                             ///< `std::nullopt`: too short to report anything
    double distance_m = 0;                   ///< length of the reported part
    double matched_m = 0;                    ///< part of distance_m on roads of the network
    /// Middle of the positions of a trip that touches no road of the network; `std::nullopt`: it
    /// touches some, or has no position.
    std::optional<GeoPoint> outside_at{};
    std::vector<std::string> warnings;
};

/// Runs the whole estimation: takes one trip and returns its passes. Uses no files, no clock, no
/// globals. Progress and errors as of trace_of().
///
/// The trip is taken by value: its acceleration is released as soon as the roughness is estimated,
/// so that ten hours of it do not occupy memory during map matching.
TripResult passes_of(TripLog trip,
                     const Vehicle& vehicle,
                     const RoadNetwork& roads,
                     const PipelineConfig& config,
                     const Progress& progress = {});

} // namespace macadam
