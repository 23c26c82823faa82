#pragma once

#include "mapping/inference/track_lines.hpp"

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

namespace macadam {

/// A oneway road while it is drawn, as nodes in driving order. Two ways meet where they share one.
struct InferredWay {
    std::vector<std::size_t> nodes; ///< in InferredNetwork::nodes, >= 2
    std::size_t passes = 1;         ///< lines that ran along it, in the median over its nodes
    bool attached_from = false;     ///< its first node is another way's
    bool attached_to = false;       ///< its last node is
};

inline constexpr std::size_t many_passes = 4; ///< of a way that is sure to be a road

struct InferredNetwork {
    std::vector<PointEn> nodes;
    std::vector<InferredWay> ways;
};

std::vector<PointEn> points_of(const InferredNetwork& drawing, std::size_t way);

/// A point of a way.
struct TraceVertex {
    std::size_t way;
    std::size_t point;
};

/// A point of a line on a way that runs alike.
struct TraceJoin {
    TraceVertex at;
    double away_m;
};
using TraceJoins = std::vector<std::optional<TraceJoin>>; ///< as many as the line has points

/// Which drawn vertices are near a place: a grid, so that a question costs as much as roads are
/// near.
class TraceIndex {
public:
    explicit TraceIndex(const TraceConfig& config);

    void add(const std::vector<PointEn>& line, std::size_t i, const TraceVertex& vertex);
    void add(const std::vector<PointEn>& line, std::size_t way);
    void clear() { cells_.clear(); }

    /// The nearest vertex, within `within_m`, of a way that runs about so.
    std::optional<TraceJoin> alike(const PointEn& place, double course_rad, double within_m) const;

    /// The nearest point of each way that runs about so, as far as `within_m`, in the order of
    /// ways.
    std::vector<TraceJoin>
    all_alike(const PointEn& place, double course_rad, double within_m) const;

    /// The nearest vertex, within `within_m`, however its way runs.
    std::optional<TraceJoin> nearest(const PointEn& place, double within_m) const;

private:
    struct Entry {
        PointEn before, at, after;
        double course_rad;
        TraceVertex vertex;
    };
    template <typename Visit>
    void visit_near(const PointEn& place, double within_m, Visit visit) const;
    bool is_alike(const Entry& entry, double course_rad) const;
    std::int64_t cell(double m) const;

    double spacing_m_;
    double cell_m_;
    double alike_rad_;
    std::unordered_map<std::int64_t, std::vector<Entry>> cells_;
};

/// How far from a line its ways are sought.
double seeks_m(const TraceLine& line, const TraceConfig& config);

/// Of the nearest ways alike, within seeks_m, those that a line is on: within joins_m or three sd
/// of its positions; also farther, where it only strays from them and comes back. Runs so short
/// that they only cross another road are none, and short breaks of one way are closed.
TraceJoins true_joins(TraceJoins nearest, const TraceLine& line, const TraceConfig& config);

/// For each point of the line where it is on the ways of an index.
TraceJoins joins_of(const TraceLine& line, const TraceIndex& index, const TraceConfig& config);

/// Draws the lines one after the other. What runs along a way that is drawn joins it.
InferredNetwork drawing_of(const std::vector<TraceLine>& lines, const TraceConfig& config);

/// Draws the ways once more, those of many lines first, so that those which have come to lie on
/// each other become one. \param sd_m  of the positions.
InferredNetwork drawn_again(const InferredNetwork& drawing, double sd_m, const TraceConfig& config);

} // namespace macadam
