#include "app/render/bbox_option.hpp"

#include "mapping/geometry/antimeridian.hpp"

#include <fmt/format.h>

#include <set>

namespace macadam {

std::optional<GeoBox> map_box(const Arguments& arguments) {
    const auto degrees = arguments.numbers("--bbox", 4);
    if (!degrees) {
        return std::nullopt;
    }
    const auto& d = *degrees;
    const auto is_longitude = [](double deg) { return deg >= -180 && deg <= 180; };
    const auto is_latitude = [](double deg) { return deg >= -90 && deg <= 90; };
    if (!is_longitude(d[0]) || !is_latitude(d[1]) || !is_longitude(d[2]) || !is_latitude(d[3]) ||
        d[0] == d[2] || d[1] >= d[3]) {
        throw UsageError{fmt::format("--bbox is {},{},{},{}, expected west,south,east,north in "
                                     "degrees with south < north; west > east crosses the "
                                     "antimeridian",
                                     d[0],
                                     d[1],
                                     d[2],
                                     d[3])};
    }
    return GeoBox{d[0], d[1], d[0] > d[2] ? d[2] + 360 : d[2], d[3]};
}

void visit_box(const StoreReader& store,
               SegmentFilter filter,
               const GeoBox& box,
               const std::function<void(const SegmentRecord&)>& visitor) {
    const double middle_deg = (box.west_deg + box.east_deg) / 2;
    std::set<std::string> seen; // for a box in two parts
    const auto parts = parts_on_globe(box);
    for (const auto& part : parts) {
        filter.box = part;
        store.visit(filter, [&](const SegmentRecord& record) {
            if (parts.size() > 1 && !seen.insert(name_of(record.segment.key)).second) {
                return;
            }
            auto placed = record;
            placed.segment.line = unwrapped(record.segment.line, middle_deg);
            visitor(placed);
        });
    }
}

} // namespace macadam
