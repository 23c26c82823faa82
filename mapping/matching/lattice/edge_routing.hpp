#pragma once

#include "mapping/network/road_network.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace macadam {

/// An edge that can be driven to.
struct ReachableEdge {
    EdgeId edge;
    EdgeId before; ///< from which it was entered
    float way_m;   ///< between the end of the edge of departure and the beginning of this one
    float turn_m;  ///< what turning round, or where it is forbidden, was worth
    float min_s;   ///< that the way takes at the speed limits
};

/// Ways between edges on the network, the shortest with U-turns at their price.
///
/// As a car goes along, its candidates ask for the same ways again and again, so the ways out of an
/// edge are found once and kept; only distant targets are searched one by one.
class EdgeRouter {
public:
    EdgeRouter(const RoadNetwork& roads, double u_turn_cost_m);

    /// Everything within kept_m after the end of `edge`, in the order of edges. Valid until the
    /// next call of either.
    const std::vector<ReachableEdge>& around(EdgeId edge);
    static constexpr double kept_m = 200;

    /// The same up to `longest_m`, ending as soon as all `targets` (in order) are reached. What
    /// cannot lead to them within longest_m, the rest of the way as straight as can be, is not
    /// looked at, and the rest in the order of how far it is with that: A* (P. E. Hart, N. J.
    /// Nilsson and B. Raphael, IEEE Transactions on Systems Science and Cybernetics 4 (1968), pp.
    /// 100-107). No targets: everything. Valid until the next call of either.
    const std::vector<ReachableEdge>&
    towards(EdgeId edge, std::span<const EdgeId> targets, double longest_m);

    /// What turning round at the end of `edge` is worth in metres: little at a dead end.
    double turn_m(EdgeId edge) const;

private:
    struct Label {
        ReachableEdge reached;
        std::uint32_t search; ///< the label is of this one; of an older one it is free
        bool settled;
    };
    struct Waiting {
        float cost_m; ///< with what is left at least
        EdgeId edge;
    };

    const std::vector<ReachableEdge>&
    search(EdgeId edge, std::span<const EdgeId> targets, double longest_m);
    void leave(const ReachableEdge& end, double longest_m);
    double left_m(EdgeId edge) const;
    Label& label_of(EdgeId edge);
    void grow_labels();

    /// All targets lie in this circle.
    struct Goal {
        GeoPoint centre;
        double east_m_per_deg;
        double radius_m;
    };

    Goal goal_of(std::span<const EdgeId> targets) const;

    const RoadNetwork& roads_;
    std::optional<Goal> goal_; ///< of the present search
    double u_turn_cost_m_;
    std::unordered_map<std::uint32_t, std::vector<ReachableEdge>> around_; ///< by EdgeId
    std::size_t around_count_ = 0;                                         ///< of all those
    std::vector<ReachableEdge> settled_;                                   ///< of the last search
    std::vector<Label> labels_; ///< a hash table with open addressing, a power of two long
    std::size_t labelled_ = 0;
    std::uint32_t search_ = 0;
    std::vector<Waiting> waiting_; ///< a heap, the cheapest first
};

/// Null if `edge` is not among them.
const ReachableEdge* find(const std::vector<ReachableEdge>& reached, EdgeId edge);

/// The edges between departure and `to`, without both. `to` is among the reached.
std::vector<EdgeId>
edges_before(const std::vector<ReachableEdge>& reached, EdgeId departure, EdgeId to);

} // namespace macadam
