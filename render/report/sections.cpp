#include "render/report/sections.hpp"

#include "render/report/figures.hpp"
#include "render/report/html.hpp"
#include "render/report/numbers.hpp"
#include "render/report/parts.hpp"
#include "render/scale_bar.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace macadam {
namespace {

/// Length in the classes that count as poor.
double poor_m(const Report& report) {
    double length_m = 0;
    for (std::size_t c = 1; c < report.colours.size(); ++c) {
        if (report.classes->classes[c - 1].to_mm_per_m >= report.poor_above_mm_per_m) {
            length_m += report.summary.all.classes[c].length_m;
        }
    }
    return length_m;
}

std::string key(const std::string& what, const std::string& value, const std::string& more) {
    return fmt::format(
        "<div><dt>{}</dt><dd><b>{}</b><span>{}</span></dd></div>\n", what, value, more);
}

/// A bar as wide as its length is on the map, whatever the screen makes of the picture.
std::string scale_html(double map_width_m) {
    constexpr double most_percent = 30;
    if (map_width_m <= 0) {
        return {};
    }
    const auto bar = scale_bar(map_width_m / 100, most_percent, false); // in percent, not pixels
    return fmt::format("<span class=\"scale\"><span style=\"width:{:.2f}%\"></span>{}, north "
                       "up</span>",
                       bar.width_px,
                       bar.label);
}

} // namespace

std::string head_section(const Report& report) {
    const auto& all = report.summary.all;
    const auto total = total_of(report.vehicles);
    auto html = fmt::format("<header>\n<h1>{}</h1>\n<p class=\"quiet\">Road roughness (IRI) from "
                            "the sensors of ordinary cars. {}</p>\n",
                            escaped(report.title),
                            total.trips == 0 ? "Nothing was measured yet."
                            : report.period.empty()
                                ? "The trips are not dated."
                                : fmt::format("Driven {}.", unbroken(escaped(report.period))));
    html += "<dl class=\"key\">\n";
    html += key("Measured",
                km_text(all.covered_m, all.covered_m) + " km",
                fmt::format("{} of the network of {} km, each direction counted",
                            percent_text(all.covered_m, all.network_m),
                            km_text(all.network_m, all.network_m)));
    if (all.covered_m > 0) {
        html += key("Mean IRI",
                    iri_text(all.mean.iri) + " mm/m",
                    fmt::format("90 % interval {}; {:.0f} in/mi",
                                unbroken(interval_text(all.mean)),
                                all.mean.iri * in_per_mi_of_mm_per_m));
        html += key("Poor",
                    percent_text(poor_m(report), all.covered_m),
                    fmt::format("{} km above {} mm/m",
                                km_text(poor_m(report), all.covered_m),
                                iri_text(report.poor_above_mm_per_m)));
        html += key("Poor stretches",
                    count_text(report.stretches),
                    fmt::format("of {:.0f} m or more, {} km together",
                                report.least_stretch_m,
                                km_text(report.stretches_m, all.covered_m)));
    }
    html +=
        key("Driven by",
            count_text(cars_in(report.vehicles), "car", "cars"),
            fmt::format("{}, {}",
                        count_text(total.trips, "trip", "trips"),
                        count_text(total.passes, "pass over a segment", "passes over segments")));
    return html + "</dl>\n</header>\n";
}

std::string condition_section(const Report& report) {
    const auto& all = report.summary.all;
    HtmlTable classes{"Length of road by class of roughness",
                      {{"Class"},
                       {"IRI, mm/m", true},
                       {"in/mi", true, true},
                       {"km", true},
                       {"Share", true},
                       {"90&nbsp;% range of km", true}},
                      {}};
    for (std::size_t c = 0; c < report.colours.size(); ++c) {
        const auto& range = all.classes[c];
        classes.rows.push_back({unbroken(swatch_svg(report.colours[c]) +
                                         sentence_case(report.classes->classes[c].name)),
                                range_text(*report.classes, c, false),
                                range_text(*report.classes, c, true),
                                km_text(range.length_m, all.covered_m),
                                percent_text(range.length_m, all.covered_m),
                                fmt::format("{} – {}",
                                            km_text(range.low_m, all.covered_m),
                                            km_text(range.high_m, all.covered_m))});
    }
    HtmlTable kinds{"Roughness by kind of road, IRI in mm/m",
                    {{"Kind of road"},
                     {"km", true},
                     {"Mean", true},
                     {"90&nbsp;% interval", true},
                     {"Median", true},
                     {"P85", true},
                     {"P95", true},
                     {"Classes"}},
                    {}};
    const auto add = [&](const RoadSummary& roads, const std::string& name) {
        kinds.rows.push_back({name,
                              km_text(roads.covered_m, all.covered_m),
                              iri_text(roads.mean.iri),
                              interval_text(roads.mean),
                              iri_text(roads.p50),
                              iri_text(roads.p85),
                              iri_text(roads.p95),
                              share_bar_svg(roads, *report.classes, report.colours)});
    };
    for (const auto& roads : report.summary.kinds) {
        if (roads.covered_m > 0) {
            add(roads, sentence_case(roads.kind));
        }
    }
    add(all, "All");
    kinds.sum = true;
    kinds.stacks = true;
    return "<section>\n<h2>Condition</h2>\n" + html_of(classes) +
           histogram_svg(report.histogram, all.mean, *report.classes, report.colours) +
           html_of(kinds) +
           "<p class=\"small quiet\">P85: 85 % of the length is as smooth as this or smoother. The "
           "range of a class says how much road would be in it if all readings were too high, or "
           "too low, together.</p>\n</section>\n";
}

std::string map_section(const Report& report) {
    const auto& all = report.summary.all;
    std::string legend, alt = "Map of the road network";
    for (std::size_t c = 0; c < report.colours.size(); ++c) {
        const auto name = sentence_case(report.classes->classes[c].name);
        legend += fmt::format("<li>{}{} <span class=\"quiet\">{}</span></li>\n",
                              swatch_svg(report.colours[c]),
                              name,
                              range_text(*report.classes, c, false));
        alt += fmt::format("{} {} {} km",
                           c == 0 ? " with roughness in colours:" : ",",
                           name,
                           km_text(all.classes[c].length_m, all.covered_m));
    }
    return fmt::format("<section>\n<h2>Map</h2>\n<ul class=\"legend\" aria-label=\"Legend: IRI in "
                       "mm/m\">\n<li class=\"quiet\">IRI in mm/m:</li>\n{}"
                       "<li><span class=\"road\"></span>No measurement</li>\n</ul>\n"
                       "<figure class=\"map\" style=\"--shape:{:.3f}\">{}<figcaption>{}A thin line "
                       "has few passes or a wide "
                       "interval. {}</figcaption></figure>\n</section>\n",
                       legend,
                       static_cast<double>(report.map.width_px) / std::max(1, report.map.height_px),
                       picture_html(report.map, alt),
                       scale_html(report.map_width_m),
                       escaped(report.attribution));
}

std::string coverage_section(const Report& report) {
    const auto& all = report.summary.all;
    HtmlTable table{"Kilometres by kind of road, each direction counted",
                    {{"Kind of road"},
                     {"On the map", true},
                     {"At least 1 pass", true},
                     {"Share", true},
                     {"At least 3 passes", true},
                     {"Share", true}},
                    {}};
    const auto add = [&](const RoadSummary& roads, const std::string& name) {
        table.rows.push_back({name,
                              km_text(roads.network_m, all.network_m),
                              km_text(roads.covered_m, all.network_m),
                              percent_text(roads.covered_m, roads.network_m),
                              km_text(roads.thrice_m, all.network_m),
                              percent_text(roads.thrice_m, roads.network_m)});
    };
    for (const auto& roads : report.summary.kinds) {
        add(roads, sentence_case(roads.kind));
    }
    add(all, "All");
    table.sum = true;
    return fmt::format("<section>\n<h2>Coverage</h2>\n{}<p class=\"small quiet\">{} of {} "
                       "segments of about {:g} m have a pass. Slip roads count with their road. "
                       "What was driven is no random sample of the network.</p>\n</section>\n",
                       html_of(table),
                       count_text(report.segments_with_passes),
                       count_text(report.segments),
                       report.segment_length_m);
}

} // namespace macadam
