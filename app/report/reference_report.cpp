#include "app/report/reference_report.hpp"

#include "app/report/control_monitoring.hpp"

#include "estimator/common/error.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace macadam {
namespace {

/// Maximum row length, in segments, of a survey that is compared with single segments.
constexpr double max_segments_in_row = 1.5;

struct Span {
    std::optional<std::int64_t> first_ms;
    std::optional<std::int64_t> last_ms;
};

void widen(Span& span, const std::optional<std::int64_t>& utc_ms) {
    if (utc_ms) {
        span.first_ms = std::min(span.first_ms.value_or(*utc_ms), *utc_ms);
        span.last_ms = std::max(span.last_ms.value_or(*utc_ms), *utc_ms);
    }
}

ComparedDays days_of(const Span& span) {
    const auto day = [](std::int64_t utc_ms) { return utc_day(utc_ms); };
    return span.first_ms ? ComparedDays{day(*span.first_ms), day(*span.last_ms)} : ComparedDays{};
}

/// Joins neighbours into ranges.
std::vector<SegmentRange> ranges_of(const std::vector<ReferenceReading>& readings) {
    std::vector<SegmentRange> ranges;
    for (const auto& reading : readings) {
        const auto& [way_id, forward, index] = reading.segment.key;
        const bool same_road =
            !ranges.empty() && ranges.back().way_id == way_id && ranges.back().forward == forward;
        if (same_road && index <= ranges.back().past) {
            ranges.back().past = std::max(ranges.back().past, index + 1);
        } else {
            ranges.push_back({way_id, forward, index, index + 1});
        }
    }
    return ranges;
}

std::map<SegmentKey, SegmentState> cars_over(const StoreReader& store,
                                             const std::vector<ReferenceReading>& readings) {
    SegmentFilter filter;
    filter.ranges = ranges_of(readings);
    filter.cars_alone = true;
    std::map<SegmentKey, SegmentState> states;
    store.visit(filter, [&](const SegmentRecord& record) {
        states.emplace(record.segment.key, *record.state);
    });
    return states;
}

std::vector<ReferencedSegment> compared_segments(const StoreReader& store,
                                                 const std::vector<SurveyUse>& surveys) {
    const auto readings = store.reference_readings();
    const auto cars =
        readings.empty() ? std::map<SegmentKey, SegmentState>{} : cars_over(store, readings);
    std::vector<ReferencedSegment> segments;
    for (const auto& reading : readings) {
        if (const auto found = cars.find(reading.segment.key); found != cars.end()) {
            segments.push_back({.segment = reading.segment,
                                .reference = reading.pass,
                                .survey = reading.survey,
                                .reference_utc_ms = surveys[reading.survey].utc_ms,
                                .cars = found->second});
        }
    }
    return segments;
}

ComparedPieces compared(std::vector<ReferencePair> pairs) {
    ComparedPieces pieces;
    pieces.headline = reference_scores(pairs_of(pairs, ComparedSide::headline));
    pieces.left = reference_scores(pairs_of(pairs, ComparedSide::left));
    pieces.right = reference_scores(pairs_of(pairs, ComparedSide::right));
    pieces.pairs = std::move(pairs);
    return pieces;
}

SurveyScore score_of_survey(const std::vector<ReferencePair>& pairs, std::size_t survey) {
    std::vector<ReferencePair> its;
    std::ranges::copy_if(pairs, std::back_inserter(its), [&](const ReferencePair& pair) {
        return pair.survey == survey;
    });
    return score_of(pairs_of(its, ComparedSide::headline));
}

/// Summarises the days from the reference to the newest pass of each segment.
std::optional<DaysAfter> days_after_of(const std::vector<ReferencePair>& pairs) {
    std::vector<double> days;
    for (const auto& pair : pairs) {
        if (pair.days_after) {
            days.push_back(*pair.days_after);
        }
    }
    if (days.empty()) {
        return std::nullopt;
    }
    std::ranges::sort(days);
    return DaysAfter{.least = days.front(), .middle = days[days.size() / 2], .most = days.back()};
}

std::vector<ComparedControl> controls_of(const StoreReader& store) {
    std::vector<ComparedControl> controls;
    for (const auto& watched : watched_sections(store)) {
        controls.push_back({.name = watched.section.name,
                            .known = watched.section.iri_mm_per_m,
                            .cars = watched.cars,
                            .off = watched.off,
                            .off_sd = watched.off_sd,
                            .months = watched.months.size(),
                            .drift = watched.drift});
    }
    return controls;
}

void add_spans(ReferenceReport& report,
               const std::vector<ReferencedSegment>& segments,
               const std::vector<SurveyUse>& surveys) {
    Span passes, references;
    for (const auto& segment : segments) {
        widen(passes, segment.cars.first_seen_ms);
        widen(passes, segment.cars.last_seen_ms);
    }
    for (const auto& survey : surveys) {
        widen(references, survey.utc_ms);
    }
    report.passed = days_of(passes);
    report.surveyed = days_of(references);
}

} // namespace

ReferenceReport
reference_report(const StoreReader& store, const std::string& title, const Localisation& wording) {
    const auto surveys = store.surveys();
    ReferenceReport report;
    report.wording = wording;
    report.title = title;
    report.is_own = store.settings().privacy == PrivacyProfile::own;
    report.segment_length_m = store.settings().segment_length_m;
    report.controls = controls_of(store);
    if (surveys.empty() && report.controls.empty()) {
        throw InputError{fmt::format("{}: contains no reference survey and no control section; "
                                     "import one with 'macadam import STORE --reference "
                                     "FILE.csv'",
                                     store.file().string())};
    }
    auto segments = compared_segments(store, surveys);
    add_spans(report, segments, surveys);
    const auto all_pairs = segment_pairs(segments);
    report.days_after = days_after_of(all_pairs);
    report.hundreds = compared(hundred_metre_pairs(segments, report.segment_length_m));
    std::erase_if(segments, [&](const ReferencedSegment& segment) {
        return surveys[segment.survey].row_m > max_segments_in_row * report.segment_length_m;
    });
    report.segments = compared(segment_pairs(segments));
    for (std::size_t i = 0; i < surveys.size(); ++i) {
        const auto& use = surveys[i];
        report.surveys.push_back({.name = use.name,
                                  .day = use.utc_ms ? utc_day(*use.utc_ms) : std::string{},
                                  .relative_sd = use.relative_sd,
                                  .row_m = use.row_m,
                                  .segments = use.passes,
                                  .km = use.km,
                                  .alone_km = use.alone_km,
                                  .score = score_of_survey(report.hundreds.pairs, i)});
    }
    return report;
}

} // namespace macadam
