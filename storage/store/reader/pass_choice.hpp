#pragma once

#include "storage/sqlite/sqlite.hpp"
#include "storage/store/fusion/chunk_states.hpp"
#include "storage/store/records/segment_filter.hpp"

namespace macadam {

/// Tests whether a filter selects passes, so that states are fused from these.
bool selects_passes(const SegmentFilter& filter);

/// Returns the passes that a filter selects.
///
/// \throws InputError  if the database has no such car.
PassChoice pass_choice(Database& database, const SegmentFilter& filter);

} // namespace macadam
