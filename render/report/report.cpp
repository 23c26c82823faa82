#include "render/report/report.hpp"

#include "render/report/html.hpp"
#include "render/report/sections.hpp"
#include "render/report/style.hpp"

#include <fmt/format.h>

#include <cassert>

namespace macadam {

std::string report_html(const Report& report) {
    assert(report.classes != nullptr && report.colours.size() == report.classes->classes.size());
    // The policy is a promise to the reader: the page asks nobody for anything.
    auto html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
        "style-src 'unsafe-inline'; img-src data:\">\n"
        "<meta name=\"generator\" content=\"Macadam\">\n<title>{}</title>\n<style>\n{}</style>\n"
        "</head>\n<body>\n",
        escaped(report.title),
        report_style());
    html += head_section(report);
    html += "<main>\n";
    if (report.summary.all.covered_m > 0) {
        html += condition_section(report);
    }
    html += map_section(report);
    if (report.summary.all.covered_m > 0) {
        html += worst_section(report);
    }
    html += own_sections(report);
    html += coverage_section(report);
    html += data_section(report);
    html += method_section(report);
    return html + "</main>\n" + source_section(report) + "</body>\n</html>\n";
}

} // namespace macadam
