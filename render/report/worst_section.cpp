#include "render/report/html.hpp"
#include "render/report/numbers.hpp"
#include "render/report/parts.hpp"
#include "render/report/sections.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

/// Text.
std::string name_of(const RoadStretch& stretch) {
    if (!stretch.name.empty()) {
        return stretch.name;
    }
    const auto kind = stretch.highway.empty() ? "road" : road_kind(stretch.highway);
    const bool is_noun =
        kind == "motorway" || kind == "track" || kind.ends_with("street") || kind.ends_with("road");
    return sentence_case(kind) + (is_noun ? "" : " road") + " without a name";
}

std::string passes_text(const RoadStretch& stretch) {
    return stretch.least_passes == stretch.median_passes
               ? fmt::format("{}", stretch.least_passes)
               : fmt::format("{} – {:g}", stretch.least_passes, stretch.median_passes);
}

HtmlTable table_of(const Report& report) {
    HtmlTable table{"Worst stretches, IRI in mm/m",
                    {{"Rank", true},
                     {"Road"},
                     {"Towards"},
                     {"Length, m", true},
                     {"IRI", true},
                     {"90&nbsp;% interval", true, true},
                     {"Worst segment", true, true},
                     {"Passes", true, true},
                     {"Cars", true, true}},
                    {}};
    for (const auto& [stretch, heading, reference, seen, map] : report.worst) {
        const auto rank = table.rows.size() + 1;
        table.rows.push_back({fmt::format("<a href=\"#stretch-{0}\">{0}</a>", rank),
                              breakable(name_of(stretch)),
                              escaped(heading),
                              fmt::format("{:.0f}", stretch.length_m),
                              iri_text(stretch.mean.iri),
                              interval_text(stretch.mean),
                              iri_text(stretch.worst_iri),
                              passes_text(stretch),
                              fmt::format("{}", stretch.vehicles)});
    }
    return table;
}

std::string card_of(const ReportStretch& of, std::size_t rank) {
    const auto& stretch = of.stretch;
    const auto name = escaped(name_of(stretch));
    const auto alt = fmt::format("Map of stretch {}: {}", rank, name);
    return fmt::format("<figure id=\"stretch-{}\">{}<figcaption><h3>{} · {}, towards {}</h3>"
                       "<b>IRI {}</b> ({}) over {:.0f} m<span class=\"phone\">, at worst "
                       "{}<br>{} {} by {}</span><br>"
                       "Way {}<br>Middle {:.5f}, {:.5f}<br>{}</figcaption></figure>\n",
                       rank,
                       picture_html(of.map, alt),
                       rank,
                       name,
                       escaped(of.heading),
                       iri_text(stretch.mean.iri),
                       interval_text(stretch.mean),
                       stretch.length_m,
                       iri_text(stretch.worst_iri),
                       passes_text(stretch),
                       stretch.median_passes == 1 ? "pass" : "passes",
                       count_text(stretch.vehicles, "car", "cars"),
                       escaped(of.reference),
                       stretch.middle.lat_deg,
                       stretch.middle.lon_deg,
                       of.seen.empty() ? "Not dated" : "Driven " + escaped(of.seen));
}

} // namespace

std::string worst_section(const Report& report) {
    auto html = std::string{"<section>\n<h2>Worst stretches</h2>\n"};
    if (report.worst.empty()) {
        return html + fmt::format("<p>No stretch of {:.0f} m or more has a mean IRI above {} mm/m."
                                  "</p>\n</section>\n",
                                  report.least_stretch_m,
                                  iri_text(report.poor_above_mm_per_m));
    }
    html += fmt::format(
        "<p>Poor segments that follow each other on one road in one direction are one stretch; it "
        "goes on while its mean stays above {} mm/m. {} of {:.0f} m or more {} found; {} by mean "
        "IRI {} listed.</p>\n",
        iri_text(report.poor_above_mm_per_m),
        count_text(report.stretches, "stretch", "stretches"),
        report.least_stretch_m,
        report.stretches == 1 ? "was" : "were",
        report.worst.size() == 1 ? std::string{"the worst"}
                                 : fmt::format("the worst {}", report.worst.size()),
        report.worst.size() == 1 ? "is" : "are");
    html += html_of(table_of(report));
    html += "<p class=\"small quiet\">Passes: the least that a segment has, and the median. "
            "Cars: the most that one segment has seen. The maps show the stretch in the colours of "
            "its segments, all other roads in grey, north up. Way: its number on the map, and "
            "metres from its first node, in the direction of driving.</p>\n";
    html += "<div class=\"cards\">\n";
    for (std::size_t i = 0; i < report.worst.size(); ++i) {
        html += card_of(report.worst[i], i + 1);
    }
    return html + "</div>\n</section>\n";
}

} // namespace macadam
