#pragma once

#include "mapping/conflation/way_matching.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// A candidate state of a sample with its emission cost.
struct ViterbiState {
    EdgeId edge;
    double offset_m; ///< along the edge, in its direction
    double cost;
    bool is_node = false; ///< a junction or an end in both networks
};

/// Finds the most likely sequence of candidate states (Viterbi). Besides its candidates, each
/// sample has the state "gone".
///
/// Source: A. J. Viterbi, IEEE Transactions on Information Theory 13 (1967), pp. 260-269.
class WayLattice {
public:
    explicit WayLattice(const RoadNetwork& roads) : roads_{&roads} {}

    /// Adds a sample with its candidate states.
    ///
    /// \param offset_m  along the way that is followed; ascending
    /// \param weight    length of way that the sample represents, in tens of metres
    void add(double offset_m, double weight, std::vector<ViterbiState> states);

    WayMatching likeliest() const;

private:
    struct Node {
        ViterbiState state;
        double cost;                   ///< of the best path up to this state
        std::uint32_t before;          ///< predecessor, an index into the previous column
        bool is_walked;                ///< reached along the roads from the predecessor
        std::optional<EdgeId> between; ///< a single edge passed entirely in between
    };
    struct Column {
        double offset_m;
        std::vector<Node> nodes; ///< the last one is "gone"
    };

    Node reached(const Column& from, const ViterbiState& state, double offset_m) const;

    const RoadNetwork* roads_;
    std::vector<Column> columns_;
};

} // namespace macadam
