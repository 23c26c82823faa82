#pragma once

#include "storage/kept_statements.hpp"
#include "storage/road_store.hpp"
#include "storage/row_visit.hpp"

namespace macadam {

/// Finds the rows of all segments that a filter means, each by an index where there is one, in the
/// order in which RoadStore::visit tells of them. There may be others among them: conditions that
/// no index serves are left to the caller.
///
/// \param columns  of the tables segment and state (storage/segment_row.hpp)
void each_segment_row(KeptStatements& statements,
                      const SegmentFilter& filter,
                      const char* columns,
                      const VisitRow& visit);

} // namespace macadam
