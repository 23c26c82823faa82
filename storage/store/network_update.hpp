#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/conflation/segment_correspondence.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace macadam {

/// How many passes were on the ways that a new network has not kept, and what became of them.
struct MovedPasses {
    std::size_t carried = 0; ///< something is left of them
    std::size_t lost = 0;
    std::size_t now = 0;                      ///< made of those carried
    std::vector<std::string> lost_sections{}; ///< control sections whose road is gone, by name
};

/// Makes tables way and segment hold another network and takes all that belongs to segments over to
/// it; what has to be fused is marked. Within the caller's transaction, in which keys are checked
/// at its end.
///
/// \throws InputError  if it was asked to stop.
MovedPasses move_to_network(Database& database,
                            const SegmentCorrespondences& correspondences,
                            const Progress& progress);

} // namespace macadam
