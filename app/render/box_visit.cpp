#include "app/render/box_visit.hpp"

#include "mapping/geometry/antimeridian.hpp"

namespace macadam {

void visit_box(const StoreReader& store,
               SegmentFilter filter,
               const GeoBox& box,
               const std::function<void(const SegmentRecord&)>& visitor) {
    const double middle_deg = (box.west_deg + box.east_deg) / 2;
    filter.box = box;
    store.visit(filter, [&](const SegmentRecord& record) {
        auto placed = record;
        placed.segment.line = unwrapped(record.segment.line, middle_deg);
        visitor(placed);
    });
}

} // namespace macadam
