#include "app/site/site_names.hpp"

#include "app/site/site_json.hpp"
#include "storage/store/rows/segment_row.hpp"
#include "storage/text/case_folding.hpp"
#include "storage/text/json.hpp"

namespace macadam {

void add_name(SiteNames& names, const SegmentRecord& record) {
    if (record.name.empty()) {
        return;
    }
    const auto box = box_around(record.segment.line);
    auto& entry =
        names.try_emplace(case_folded(record.name), SiteName{record.name, record.segment.key, box})
            .first->second;
    const double length_m = record.segment.to_m - record.segment.from_m;
    entry.box = joined_box(entry.box, box);
    entry.length_m += length_m;
    entry.iri_m += length_m * mm_per_m(record.state->iri_um);
}

std::string name_json(const SiteNames::value_type& name) {
    const auto& [key, road] = name;
    return JsonObject{}
        .add("name", road.name)
        .add("key", key)
        .add("km", JsonNumber{road.length_m / 1000, 3})
        .add("iri", json_number(road.iri_m / road.length_m, 2))
        .add("bounds", JsonRaw{box_json(road.box)})
        .add("segment", name_of(road.first))
        .text();
}

} // namespace macadam
