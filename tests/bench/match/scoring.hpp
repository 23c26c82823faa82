#pragma once

#include "mapping/matching/map_match.hpp"
#include "tracks.hpp"

#include <array>
#include <map>
#include <span>
#include <unordered_map>
#include <vector>

namespace macadam::bench {

/// Lengths of arcs, as haversine of a sphere of 6371.0088 km.
class ArcLengths {
public:
    explicit ArcLengths(const std::vector<Way>& ways);
    double operator()(const NodePair& arc) const;

private:
    std::unordered_map<std::int64_t, GeoPoint> places_; ///< by node
};

/// Lengths of what was driven, of what was matched, and of what is in both. An arc driven twice
/// counts twice.
struct Score {
    double truth_m = 0;
    double matched_m = 0;
    double common_m = 0;

    double missed_m() const { return truth_m - common_m; }
    double wrong_m() const { return matched_m - common_m; }
};

/// An arc that a matcher found.
struct FoundArc {
    NodePair nodes;
    double confidence;
};

std::vector<FoundArc> found_arcs(const MatchedTrace& trace, const RoadNetwork& roads);

Score score_of(std::span<const NodePair> truth,
               std::span<const FoundArc> found,
               const ArcLengths& length_m);

/// Of many tracks. Source: Newson, Krumm 2009 (RMF).
struct Totals {
    double wcf; ///< common over the longer of truth and matched, all tracks together
    double mcf; ///< mean over tracks of the same
    double rmf; ///< (missed + wrong) / truth
    std::size_t empty;
};
Totals totals_of(std::span<const Score> scores);

/// How often a matcher is right, over the confidence that it gives itself.
class Calibration {
public:
    void add(std::span<const NodePair> truth,
             std::span<const FoundArc> found,
             const ArcLengths& length_m);

    struct Bin {
        double length_m = 0;
        double confidence_m = 0; ///< length * confidence
        double right_m = 0;
    };
    const std::array<Bin, 10>& bins() const { return bins_; }

    /// Mean distance of confidence and share of what is right, weighed by length.
    double expected_error() const;

    /// Of the length, how much is sure_from or surer; of that, how much is wrong.
    double sure_share() const;
    double sure_wrong_share() const;
    static constexpr double sure_from = 0.95;

private:
    std::array<Bin, 10> bins_;
    double sure_m_ = 0;
    double sure_wrong_m_ = 0;
};

} // namespace macadam::bench
