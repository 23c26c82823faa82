#pragma once

#include "mapping/network/road_network.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace macadam {

/// An edge reached by the search.
struct ReachableEdge {
    EdgeId edge;
    EdgeId before; ///< predecessor edge
    float way_m;   ///< between the end of the departure edge and the start of this one
    float turn_m;  ///< cost of turning round or of forbidden turns
    float min_s;   ///< minimum driving time at the speed limits
};

/// Finds shortest paths between edges of the network, with U-turns at their cost. Consecutive
/// samples ask for the same paths repeatedly, so the surroundings of an edge are searched once and
/// cached; only distant targets are searched individually.
class EdgeRouter {
public:
    EdgeRouter(const RoadNetwork& roads, double u_turn_cost_m);

    /// Returns all edges within kept_m after the end of `edge`, in edge order. Valid until the next
    /// call of `around` or `towards`.
    const std::vector<ReachableEdge>& around(EdgeId edge);
    static constexpr double kept_m = 200;

    /// Searches up to `longest_m`, stopping once all `targets` (sorted) are reached, with A*: edges
    /// are expanded in the order of their distance plus the straight-line distance to the targets,
    /// and skipped if that exceeds longest_m (P. E. Hart, N. J. Nilsson and B. Raphael, IEEE
    /// Transactions on Systems Science and Cybernetics 4 (1968), pp. 100-107). Without targets,
    /// returns all edges in range. Valid until the next call of `around` or `towards`.
    const std::vector<ReachableEdge>&
    towards(EdgeId edge, std::span<const EdgeId> targets, double longest_m);

    /// Returns the cost in metres of turning round at the end of `edge`: low at a dead end.
    double turn_m(EdgeId edge) const;

private:
    struct Label {
        ReachableEdge reached;
        std::uint32_t search; ///< the search that set the label; if older, the label is free
        bool settled;
    };
    struct Waiting {
        float cost_m; ///< including the minimum remaining distance
        EdgeId edge;
    };

    const std::vector<ReachableEdge>&
    search(EdgeId edge, std::span<const EdgeId> targets, double longest_m);
    void leave(const ReachableEdge& end, double longest_m);
    double left_m(EdgeId edge) const;
    Label& label_of(EdgeId edge);
    void grow_labels();

    /// A circle that contains all targets.
    struct Goal {
        GeoPoint centre;
        double east_m_per_deg;
        double radius_m;
    };

    Goal goal_of(std::span<const EdgeId> targets) const;

    const RoadNetwork& roads_;
    std::optional<Goal> goal_; ///< of the current search
    double u_turn_cost_m_;
    std::unordered_map<std::uint32_t, std::vector<ReachableEdge>> around_; ///< by EdgeId
    std::size_t around_count_ = 0;       ///< total number of entries
    std::vector<ReachableEdge> settled_; ///< by the last search
    std::vector<Label> labels_; ///< a hash table with open addressing; its size is a power of two
    std::size_t labelled_ = 0;
    std::uint32_t search_ = 0;
    std::vector<Waiting> waiting_; ///< a heap, cheapest first
};

/// Finds an edge; nullptr if it was not reached.
const ReachableEdge* find(const std::vector<ReachableEdge>& reached, EdgeId edge);

/// Returns the edges between departure and `to`, excluding both. `to` is among the reached.
std::vector<EdgeId>
edges_before(const std::vector<ReachableEdge>& reached, EdgeId departure, EdgeId to);

} // namespace macadam
