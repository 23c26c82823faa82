#pragma once

#include "bench/match/newson_krumm.hpp"
#include "mapping/matching/map_match.hpp"
#include "simulated_drive.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace macadam::bench {

/// What matching makes of a log: the latency found (if the log does not state it), the ruler, and
/// the pieces on it.
struct Matched {
    std::optional<double> latency_s; ///< stated or estimated; nothing: taken for 0
    Odometer odometer;
    MatchedTrace trace;
};

/// As `macadam match` does it.
Matched matched(TripLog trip, const RoadNetwork& roads, const MatchConfig& config = {});

/// Metres of truth by how they were matched, and by how sure.
struct ConfidenceBin {
    double length_m = 0;
    double right_m = 0;
    double confidence_m = 0; ///< sum of confidence over length
};

/// What was driven and what was matched, edge by edge whatever the time: for matchers that give no
/// times. An edge driven twice counts twice.
struct RouteScore {
    double truth_m = 0;
    double matched_m = 0;
    double common_m = 0;

    /// Missed and wrong length over the true one. Source: Newson, Krumm 2009.
    double mismatch() const { return (truth_m + matched_m - 2 * common_m) / truth_m; }
};

/// A part of the true route that was not matched to it.
struct Fault {
    double from_m;
    double to_m;
    const char* what;
};

/// How near matching came to the truth of one or more drives. Counted at each metre of the true
/// route from where the first position was taken to where the last one was.
///
/// A metre is right if the matched place lies on the true edge in the true direction, or elsewhere
/// on the true route no more than `junction_m` before or behind the truth: that is an error of
/// place along the right way, which happens to lead over a junction, and is counted as such.
struct DriveScore {
    static constexpr double junction_m = 10;
    static constexpr double sure = 0.95; ///< confidence from here on

    std::size_t drives = 0;
    std::size_t empty = 0; ///< drives of which nothing was matched to a road
    std::size_t gaps = 0;  ///< pieces of that kind, of a metre or more
    std::size_t positions = 0;
    double length_m = 0;
    double right_m = 0;
    double same_edge_m = 0;   ///< of right_m: not beyond a junction
    double wrong_m = 0;       ///< on another road, or far along the right one
    double off_network_m = 0; ///< said to be off the network
    double gap_m = 0;         ///< said to be a gap, or nothing said
    double outage_m = 0;      ///< length without positions for `outage_s` or more
    double outage_right_m = 0;
    std::vector<float> error_m;        ///< place along the route less the truth, outside outages
    std::vector<float> outage_error_m; ///< the same inside
    std::array<ConfidenceBin, 10> confidence;
    double sure_m = 0;
    double sure_wrong_m = 0;
    std::vector<float> latency_error_s;
    RouteScore route;
    std::vector<Fault> faults; ///< of one drive
};

struct ScoreRule {
    double junction_m = 10;
    double outage_s = 20; ///< a silence of the receiver of so many seconds is an outage
};

DriveScore score_of(const Drive& drive,
                    const Recording& recording,
                    const Matched& matched,
                    const ScoreRule& rule = {});

RouteScore
route_score_of(const Drive& drive, const Recording& recording, std::span<const DrivenEdge> matched);

std::vector<DrivenEdge> driven_edges(const MatchedTrace& trace);

RouteScore together(const RouteScore& a, const RouteScore& b);
DriveScore together(DriveScore sum, const DriveScore& one);

/// Mean difference of confidence and share of right length, over bins weighed by their length.
double calibration_error(const DriveScore& score);

/// \param share  0 to 1. \returns NaN of no values.
double quantile(std::vector<float> values, double share);

/// Of their sizes.
double absolute_quantile(std::vector<float> values, double share);

} // namespace macadam::bench
