#pragma once

#include "mapping/conflation/candidate_edges.hpp"

#include <cstdint>
#include <set>
#include <vector>

namespace macadam {

/// A position on a way in one direction, and on the edge it is matched to.
struct WayMatchPoint {
    double offset_m; ///< from the start of the way in that direction; ascending within a run
    EdgeId edge;
    double along_m;       ///< along the edge, in its direction
    bool is_node = false; ///< a junction or an end in both networks
};

/// An unbroken run along both networks. Each change of edge occurs twice, at the ends of both
/// edges.
using WayMatchRun = std::vector<WayMatchPoint>;

struct WayMatching {
    double cost = 0; ///< -log likelihood, up to a constant
    std::vector<WayMatchRun> runs;
};

/// Matches ways of one network to another.
class WayMatcher {
public:
    /// \param left_out  ways of `after` that are no candidates. All arguments outlive this object.
    WayMatcher(const RoadNetwork& before,
               const RoadNetwork& after,
               const std::vector<bool>& left_out,
               const ChangeConfig& config);

    /// Finds the most likely match of a way in one direction.
    ///
    /// \param barred  edges that must not be used
    WayMatching match(std::uint32_t way, bool forward, const std::set<EdgeId>& barred = {}) const;

private:
    std::vector<RoadSample> samples_of(const WayView& way, bool forward) const;

    const RoadNetwork* before_;
    const RoadNetwork* after_;
    CandidateEdges near_;
    ChangeConfig config_;
    std::vector<std::uint32_t> met_before_; ///< number of links that meet, by node
    std::vector<std::uint32_t> met_after_;
};

} // namespace macadam
