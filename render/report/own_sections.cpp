#include "render/report/html.hpp"
#include "render/report/numbers.hpp"
#include "render/report/parts.hpp"
#include "render/report/sections.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

constexpr const char* no_value = "–";

std::string passes_text(const MeasuredRoad& road) {
    return road.least_passes == road.median_passes
               ? fmt::format("{}", road.least_passes)
               : fmt::format("{} – {:g}", road.least_passes, road.median_passes);
}

std::vector<std::string> row_of(const ReportSection& section, const ClassTable& classes) {
    const auto& mean = section.measured.mean;
    const bool measured = mean.length_m > 0;
    return {breakable(section.name),
            fmt::format("{:.0f}", section.from_m),
            fmt::format("{:.0f}", section.to_m),
            section.excluded_m > 0 ? fmt::format("{:.0f}", section.excluded_m) : no_value,
            percent_text(section.open_share, 1),
            measured ? iri_text(mean.iri) : no_value,
            measured ? interval_text(mean) : no_value,
            measured ? sentence_case(classes.classes[class_index(classes, mean.iri)].name)
                     : no_value,
            measured ? passes_text(section.measured) : "0"};
}

} // namespace

std::string own_sections(const Report& report) {
    if (report.sections.empty()) {
        return "";
    }
    HtmlTable table{"Sections, IRI in mm/m",
                    {{"Section"},
                     {"From, m", true},
                     {"To, m", true},
                     {"Excluded, m", true, true},
                     {"Covered", true},
                     {"IRI", true},
                     {"90&nbsp;% interval", true, true},
                     {"Class"},
                     {"Passes", true, true}},
                    {}};
    for (const auto& section : report.sections) {
        table.rows.push_back(row_of(section, *report.classes));
    }
    return "<section>\n<h2>Sections</h2>\n<p>Means weighted by length. Intervals count errors that "
           "are alike all along a section, as of cars and method, in full. Stations fall where a "
           "road is driven against them. Passes: the least that a segment has, and the median."
           "</p>\n" +
           html_of(table) + "</section>\n";
}

} // namespace macadam
