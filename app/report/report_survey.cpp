#include "app/report/report_survey.hpp"

#include <string_view>
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

/// Collects segments without their lines, each text once.
class SegmentCollector {
public:
    void add(const SegmentRecord& record) {
        auto segment = measured_segment(record);
        segment.name = kept(record.name);
        segment.highway = kept(record.highway);
        measured_.push_back(segment);
    }

    void put_into(Survey& survey) && {
        survey.measured = std::move(measured_);
        survey.texts = std::move(texts_);
    }

private:
    std::string_view kept(const std::string& text) { return *texts_->insert(text).first; }

    std::vector<MeasuredSegment> measured_;
    std::shared_ptr<std::set<std::string, std::less<>>> texts_ =
        std::make_shared<std::set<std::string, std::less<>>>();
};

} // namespace

Survey survey_of(const StoreReader& store, const SegmentFilter& filter) {
    Survey survey;
    SegmentCollector collector;
    const bool selects_places_alone = filter.class_name.empty() && filter.min_passes == 0 &&
                                      filter.min_vehicles == 0 && filter.vehicle.empty() &&
                                      !filter.period;
    store.visit(places_of(filter), [&](const SegmentRecord& record) {
        ++survey.segments;
        survey.network_m[record.highway] += record.segment.to_m - record.segment.from_m;
        if (selects_places_alone && record.state) {
            collector.add(record);
        }
    });
    if (!selects_places_alone) {
        store.visit(filter, [&](const SegmentRecord& record) { collector.add(record); });
    }
    std::move(collector).put_into(survey);
    return survey;
}

} // namespace macadam
