#pragma once

#include "estimator/common/progress.hpp"
#include "estimator/common/trip.hpp"
#include "mapping/network/road_network.hpp"

#include <span>
#include <string>
#include <vector>

namespace macadam {

struct TraceConfig {
    double spacing_m = 10; ///< of the points of a traced way
    double joins_m = 15;   ///< nearer than this to a traced way that runs alike: the same road;
                           ///< farther (to 40 m) where 3 sd of the positions are more
    double joins_deg = 40; ///< how alike
    double min_way_m = 50; ///< shorter pieces are noise
    double worst_accuracy_m = 30;
    double longest_gap_s = 10; ///< no road is drawn through a longer silence
};

/// What a trip drew: all that tracing needs of it.
struct TripDrawing {
    struct Line {
        std::vector<GeoPoint> points; ///< about spacing_m apart
        double sd_m;                  ///< of its positions, as the receiver says
        bool after_turn;              ///< begins where the line before it turned round
    };
    std::string sha256; ///< of the trip's content
    std::vector<Line> lines;
};

/// Lines of the trip while it drove: standing, jumps, silences and turning round draw nothing.
TripDrawing trip_drawing(const TripLog& trip, const TraceConfig& config);

/// Roads drawn by the trips themselves, where there is no map: oneway ways in driving direction,
/// numbered from 1. The two directions of a road are two ways.
///
/// Trips are taken in the order of their content, so that the order of the call does not matter;
/// one that occurs twice counts once. A part that runs along a way already drawn, in the same
/// direction, is not drawn again but joins it. Then every way is moved to the middle of all trips
/// that ran along it (a mean without the fifth at either end), ways that come to lie on each other
/// become one, and ways of a single trip beside a road of many are left out. Ways meet where trips
/// turned from one to the other; roads that only cross stay apart, for the one may be a bridge.
///
/// Time and memory grow with the length of all trips: neighbours come from a grid.
std::vector<Way> trace_network(std::span<const TripDrawing> trips,
                               const TraceConfig& config,
                               const Progress& progress = {});

/// The same from whole trips.
std::vector<Way> trace_network(std::span<const TripLog> trips, const TraceConfig& config);

} // namespace macadam
