#include "render/report/report.hpp"

#include "render/report/common_parts.hpp"
#include "render/report/sections.hpp"
#include "render/scene/isolated_text.hpp"

#include <cassert>

namespace macadam {

Document report_document(const Report& report) {
    assert(report.classes != nullptr && report.colours.size() == report.classes->classes.size());
    const auto& say = report.wording;
    const auto period = say.period(report.period.first, report.period.last);
    Document document{.language = say.language->code,
                      .title = report.title,
                      .subtitle = subtitle_of(report),
                      .running_head =
                          isolated(report.title) + (period.empty() ? "" : " · " + period),
                      .page_of = *find_message(*say.language, "page"),
                      .day = report.period.last,
                      .keys = key_numbers(report),
                      .sections = {},
                      .end = {source_section(report)},
                      .lead = lead_of(report),
                      .overview = overview_of(report),
                      .words = page_words(say, true)};
    const bool measured = report.summary.all.covered_m > 0;
    if (!report.strips.empty()) {
        document.sections.push_back(strip_section(report));
    }
    if (measured) {
        document.sections.push_back(condition_section(report));
        document.sections.push_back(worst_section(report));
    }
    if (!report.events.empty()) {
        document.sections.push_back(events_section(report));
    }
    if (report.change) {
        document.sections.push_back(change_section(report));
    }
    if (!report.sections.empty()) {
        document.sections.push_back(own_sections(report));
    }
    document.sections.push_back(coverage_section(report));
    document.sections.push_back(data_section(report));
    document.sections.push_back(reading_section(report));
    document.sections.push_back(method_section(report));
    document.sections.push_back(limits_section(report));
    return document;
}

std::string report_html(const Report& report) {
    return html_of(report_document(report));
}

} // namespace macadam
