#pragma once

#include "storage/sqlite/row_callback.hpp"
#include "storage/sqlite/statement_cache.hpp"
#include "storage/store/road_store.hpp"

namespace macadam {

/// Finds the rows of all segments that a filter means, each by an index where there is one, in the
/// order in which RoadStore::visit tells of them. There may be others among them: conditions that
/// no index serves are left to the caller.
///
/// \param columns  of the tables segment and state (storage/store/rows/segment_row.hpp)
void each_segment_row(StatementCache& statements,
                      const SegmentFilter& filter,
                      const char* columns,
                      const VisitRow& visit);

} // namespace macadam
