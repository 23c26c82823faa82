#include "render/report/common_parts.hpp"
#include "render/report/sections.hpp"

namespace macadam {

using namespace document;

namespace {

constexpr const char* no_value = "–";

std::vector<Cell> row_of(const Report& report, const ReportSection& section) {
    const auto& say = report.wording;
    const auto& mean = section.measured.mean;
    const bool measured = mean.length_m > 0;
    return {section.name,
            say.short_length(section.from_m),
            say.short_length(section.to_m),
            section.excluded_m > 0 ? say.short_length(section.excluded_m) : no_value,
            say.percent(section.open_share, 1),
            measured ? say.iri(mean.iri) : no_value,
            measured ? say.interval(mean) : no_value,
            measured ? class_name(report, class_index(*report.classes, mean.iri)) : no_value,
            measured ? passes_text(say, section.measured.min_passes, section.measured.median_passes)
                     : "0"};
}

} // namespace

DocumentSection own_sections(const Report& report) {
    const auto& say = report.wording;
    Table table{say("sections.caption", {{"unit", std::string{say.iri_unit()}}}),
                {{say("column.section")},
                 {say("column.from_m"), true},
                 {say("column.to_m"), true},
                 {say("column.excluded_m"), true, true},
                 {say("column.covered"), true},
                 {"IRI", true},
                 {say("column.interval"), true, true},
                 {say("column.class")},
                 {say("column.passes"), true, true}},
                {}};
    for (const auto& section : report.sections) {
        table.rows.push_back(row_of(report, section));
    }
    return {say("sections"), {Paragraph{say("sections.about")}, table}};
}

} // namespace macadam
