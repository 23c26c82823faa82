#pragma once

#include "mapping/conflation/candidate_edges.hpp"

#include <cstdint>
#include <set>
#include <vector>

namespace macadam {

/// A place of a way, in one direction, and of the edge that it has become.
struct WalkPlace {
    double offset_m; ///< from where the way begins in that direction; rising within a run
    EdgeId edge;
    double along_m;       ///< along the edge, in its direction
    bool is_node = false; ///< a junction or an end in both networks
};

/// Walked along both without a break. Each change of edge stands there twice, at both edges' ends.
using WalkRun = std::vector<WalkPlace>;

struct WayMatching {
    double cost = 0; ///< minus the logarithm of its likelihood, but for a constant
    std::vector<WalkRun> runs;
};

/// Follows ways of one network through another.
class RoadWalker {
public:
    /// \param left_out  ways of `after` that are no candidates. All outlive this.
    RoadWalker(const RoadNetwork& before,
               const RoadNetwork& after,
               const std::vector<bool>& left_out,
               const ChangeConfig& config);

    /// The likeliest course of a way that is followed in one direction.
    /// \param barred  edges that it must not take
    WayMatching walk(std::uint32_t way, bool forward, const std::set<EdgeId>& barred = {}) const;

private:
    std::vector<RoadSample> samples_of(const WayView& way, bool forward) const;

    const RoadNetwork* before_;
    const RoadNetwork* after_;
    CandidateEdges near_;
    ChangeConfig config_;
    std::vector<std::uint32_t> met_before_; ///< links that meet, by node
    std::vector<std::uint32_t> met_after_;
};

} // namespace macadam
