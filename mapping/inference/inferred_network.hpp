#pragma once

#include "mapping/inference/track_lines.hpp"

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

namespace macadam {

/// A oneway road under construction, as nodes in driving order. Two ways meet where they share a
/// node.
struct InferredWay {
    std::vector<std::size_t> nodes; ///< indices into InferredNetwork::nodes, >= 2
    std::size_t passes = 1;         ///< median over its nodes of the lines that ran along it
    bool attached_from = false;     ///< its first node belongs to another way
    bool attached_to = false;       ///< its last node belongs to another way
};

inline constexpr std::size_t many_passes = 4; ///< a way with this many passes is certainly a road

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

/// The match of a line's point to a way with a similar course.
struct TraceJoin {
    TraceVertex at;
    double away_m;
};
using TraceJoins = std::vector<std::optional<TraceJoin>>; ///< one entry per point of the line

/// A grid index of drawn vertices; the cost of a query grows with the number of roads nearby.
class TraceIndex {
public:
    explicit TraceIndex(const TraceConfig& config);

    void add(const std::vector<PointEn>& line, std::size_t i, const TraceVertex& vertex);
    void add(const std::vector<PointEn>& line, std::size_t way);
    void clear() { cells_.clear(); }

    /// Returns the nearest vertex within `within_m` on a way with a similar course.
    std::optional<TraceJoin> alike(const PointEn& place, double course_rad, double within_m) const;

    /// Returns the nearest point of each way with a similar course within `within_m`, in the order
    /// of ways.
    std::vector<TraceJoin>
    all_alike(const PointEn& place, double course_rad, double within_m) const;

    /// Returns the nearest vertex within `within_m`, whatever the course of its way.
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

/// Returns the distance within which ways are searched around a line.
double seeks_m(const TraceLine& line, const TraceConfig& config);

/// Selects from the nearest similar ways within seeks_m those that the line is really on: within
/// joins_m or three sd of its positions, or farther if the line only strays and returns. Runs so
/// short that they merely cross another road are dropped, and short breaks within one way are
/// closed.
TraceJoins true_joins(TraceJoins nearest, const TraceLine& line, const TraceConfig& config);

/// Finds for each point of the line its position on the ways of an index.
TraceJoins joins_of(const TraceLine& line, const TraceIndex& index, const TraceConfig& config);

/// Draws the lines one after the other. A part that runs along a way already drawn joins it.
InferredNetwork drawing_of(const std::vector<TraceLine>& lines, const TraceConfig& config);

/// Redraws the ways, those with many lines first, so that ways that have come to coincide become
/// one. \param sd_m  of the positions.
InferredNetwork drawn_again(const InferredNetwork& drawing, double sd_m, const TraceConfig& config);

} // namespace macadam
