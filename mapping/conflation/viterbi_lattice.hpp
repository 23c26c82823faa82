#pragma once

#include "mapping/conflation/way_matching.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// Where a sample of a way may be, and how unlikely that is by itself.
struct WalkState {
    EdgeId edge;
    double offset_m; ///< along the edge, in its direction
    double cost;
    bool is_node = false; ///< a junction or an end in both networks
};

/// The likeliest way through places that samples may be in (Viterbi's algorithm). Beside its places
/// each sample may be nowhere.
///
/// Source: A. J. Viterbi, IEEE Transactions on Information Theory 13 (1967), pp. 260-269.
class WayLattice {
public:
    explicit WayLattice(const RoadNetwork& roads) : roads_{&roads} {}

    /// \param offset_m  along the way that is followed; rising
    /// \param weight    how much of the way it stands for, in tens of metres
    void add(double offset_m, double weight, std::vector<WalkState> states);

    WayMatching likeliest() const;

private:
    struct Node {
        WalkState state;
        double cost;                   ///< of the best way to here
        std::uint32_t before;          ///< in the previous column
        bool is_walked;                ///< along the roads, from there
        std::optional<EdgeId> between; ///< one edge that was passed whole
    };
    struct Column {
        double offset_m;
        std::vector<Node> nodes; ///< the last one: nowhere
    };

    Node reached(const Column& from, const WalkState& state, double offset_m) const;

    const RoadNetwork* roads_;
    std::vector<Column> columns_;
};

} // namespace macadam
