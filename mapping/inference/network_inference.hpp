#pragma once

#include "estimator/common/progress.hpp"
#include "estimator/common/trip.hpp"
#include "mapping/network/road_network.hpp"

#include <span>
#include <string>
#include <vector>

namespace macadam {

struct TraceConfig {
    double spacing_m = 10; ///< between the points of a traced way
    double joins_m = 15; ///< distance within which a similar way is the same road; up to 40 m where
                         ///< 3 sd of the positions exceed it
    double joins_deg = 40; ///< largest difference of course of similar ways
    double min_way_m = 50; ///< shorter ways are noise
    double worst_accuracy_m = 30;
    double longest_gap_s = 10;   ///< longer gaps are not bridged
    double longest_step_m = 400; ///< nor farther ones, so that a fix draws at most 40 points
};

/// Lines of a trip: everything that tracing needs of it.
struct TripDrawing {
    struct Line {
        std::vector<GeoPoint> points; ///< about spacing_m apart
        double sd_m;                  ///< of its positions, as stated by the receiver
        bool after_turn;              ///< begins where the line before it turned round
    };
    std::string sha256; ///< of the trip's content
    std::vector<Line> lines;
};

/// Extracts the lines that a trip drove; standing, jumps, gaps and turning round draw no line.
TripDrawing trip_drawing(const TripLog& trip, const TraceConfig& config);

/// Infers roads from trips, where there is no map: oneway ways in driving direction, numbered from
/// 1. The two directions of a road are two ways.
///
/// Trips are processed in the order of their content, so that the order of the argument does not
/// matter; duplicates count once. A part that runs along an existing way in the same direction
/// joins it. Every way is then moved to the centre of all trips that ran along it (a mean trimmed
/// by a fifth at either end), ways that come to coincide become one, and ways of a single trip
/// beside a road of many are removed. Ways meet where trips turned from one to the other; roads
/// that only cross stay separate, as one may be a bridge. Time and memory grow with the total
/// length of the trips: neighbours come from a grid.
std::vector<Way> trace_network(std::span<const TripDrawing> trips,
                               const TraceConfig& config,
                               const Progress& progress = {});

/// Infers roads from complete trips.
std::vector<Way> trace_network(std::span<const TripLog> trips, const TraceConfig& config);

} // namespace macadam
