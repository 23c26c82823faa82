#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/conflation/segment_correspondence.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace macadam {

/// Counts of the passes on ways that the new network does not keep, by their outcome.
struct MovedPasses {
    std::size_t carried = 0; ///< at least partly transferred
    std::size_t lost = 0;
    std::size_t now = 0;                      ///< passes that they became
    std::vector<std::string> lost_sections{}; ///< control sections whose road is gone
};

/// Replaces the network in the tables way and segment, transfers all data of the segments to it,
/// and marks the chunks to be fused. Runs within the caller's transaction, with foreign keys
/// checked at its end.
///
/// \throws InputError  if a stop is requested.
MovedPasses move_to_network(Database& database,
                            const SegmentCorrespondences& correspondences,
                            const Progress& progress);

} // namespace macadam
