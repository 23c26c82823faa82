#pragma once

#include "storage/sqlite/row_callback.hpp"
#include "storage/sqlite/statement_cache.hpp"
#include "storage/store/schema/segment_filter.hpp"

namespace macadam {

/// Visits the rows of all segments that match a filter, in the order of RoadStore::visit, by an
/// index where there is one. The result may contain more segments: conditions without an index are
/// left to the caller.
///
/// \param columns  of the tables segment and state (storage/store/rows/segment_row.hpp)
void each_segment_row(StatementCache& statements,
                      const SegmentFilter& filter,
                      const char* columns,
                      const VisitRow& visit);

} // namespace macadam
