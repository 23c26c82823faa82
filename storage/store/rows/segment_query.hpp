#pragma once

#include "storage/sqlite/row_callback.hpp"
#include "storage/sqlite/statement_cache.hpp"
#include "storage/store/records/segment_filter.hpp"

#include <memory>
#include <span>
#include <vector>

namespace macadam {

/// Visits the rows of all segments that match a filter, in the order of StoreReader::visit, by an
/// index where there is one. The result may contain more segments: conditions without an index are
/// left to the caller.
///
/// \param columns  of the tables segment and state (storage/store/rows/segment_row.hpp)
void each_segment_row(StatementCache& statements,
                      const SegmentFilter& filter,
                      const char* columns,
                      const VisitRow& visit);

/// The box and the area of a filter, whose index gives too many segments.
class PlaceCondition {
public:
    explicit PlaceCondition(const SegmentFilter& filter);

    /// \param line  of a segment; at least one point
    bool holds_for(std::span<const GeoPoint> line) const;

private:
    std::vector<GeoBox> boxes_; ///< empty: everywhere
    std::shared_ptr<const Area> area_;
};

} // namespace macadam
