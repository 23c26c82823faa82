#include "app/report/report_survey.hpp"

#include <utility>

namespace macadam {
namespace {

/// Returns the conditions of a filter on places, which unmeasured segments meet, too.
SegmentFilter places_of(SegmentFilter filter) {
    filter.with_state_only = false;
    filter.class_name.clear();
    filter.min_passes = 0;
    filter.min_vehicles = 0;
    filter.vehicle.clear();
    filter.period.reset();
    return filter;
}

} // namespace

Survey survey_of(const StoreReader& store, const SegmentFilter& filter) {
    Survey survey;
    MeasuredSegments collected;
    const bool selects_places_alone = filter.class_name.empty() && filter.min_passes == 0 &&
                                      filter.min_vehicles == 0 && filter.vehicle.empty() &&
                                      !filter.period;
    store.visit(places_of(filter), [&](const SegmentRecord& record) {
        ++survey.segments;
        survey.network_m[record.highway] += record.segment.to_m - record.segment.from_m;
        if (selects_places_alone && record.state) {
            collected.add(record);
        }
    });
    if (!selects_places_alone) {
        store.visit(filter, [&](const SegmentRecord& record) { collected.add(record); });
    }
    survey.measured = std::move(collected.segments);
    survey.texts = std::move(collected.texts);
    return survey;
}

} // namespace macadam
