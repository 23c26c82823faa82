#include "render/report/reference_page.hpp"

#include "render/report/html.hpp"
#include "render/report/numbers.hpp"
#include "render/report/parts.hpp"
#include "render/report/reference_figures.hpp"
#include "render/report/style.hpp"

#include <fmt/format.h>

#include <cmath>

namespace macadam {
namespace {

constexpr const char* no_value = "–";
constexpr double z_of_90_percent = 1.645;

std::string number_text(double value, int decimals) {
    return std::isnan(value) ? no_value : fmt::format("{:.{}f}", value, decimals);
}

std::string signed_text(double value) {
    return std::isnan(value) ? no_value : fmt::format("{:+.2f}", value);
}

std::string level_text(const SurveyScore& score) {
    return std::isinf(score.to_mm_per_m)
               ? fmt::format("{:g} and more", score.from_mm_per_m)
               : fmt::format("{:g} – {:g}", score.from_mm_per_m, score.to_mm_per_m);
}

std::vector<std::string> cells_of(const std::string& name, const SurveyScore& score) {
    return {name,
            count_text(score.pieces),
            number_text(score.mean_survey, 2),
            number_text(score.mean_trip, 2),
            signed_text(score.bias),
            number_text(score.rmse, 2),
            number_text(score.correlation, 2),
            std::isnan(score.coverage) ? no_value : percent_text(score.coverage, 1)};
}

std::string scores_table(const std::string& caption, const ReferenceScores& scores) {
    HtmlTable table{caption,
                    {{"Reference, mm/m"},
                     {"Pieces", true},
                     {"Reference", true},
                     {"Cars", true},
                     {"Bias", true},
                     {"RMSE", true},
                     {"Correlation", true, true},
                     {"In the 90&nbsp;% interval", true}},
                    {}};
    for (const auto& score : scores.by_level) {
        table.rows.push_back(cells_of(level_text(score), score));
    }
    table.rows.push_back(cells_of("All", scores.all));
    table.sum = true;
    return html_of(table);
}

std::string surveys_section(const ReferenceReport& report) {
    if (report.surveys.empty()) {
        return {};
    }
    HtmlTable table{"Surveys, IRI in mm/m; scores of pieces of 100 m",
                    {{"Survey"},
                     {"Measured"},
                     {"Good to", true, true},
                     {"Rows, m", true, true},
                     {"Segments", true, true},
                     {"km", true},
                     {"Bias", true},
                     {"RMSE", true}},
                    {}};
    for (const auto& survey : report.surveys) {
        table.rows.push_back({breakable(survey.name),
                              survey.day.empty() ? "not known" : survey.day,
                              fmt::format("{:g} %", 100 * survey.relative_sd),
                              fmt::format("{:.0f}", survey.row_m),
                              count_text(survey.segments),
                              fmt::format("{:.2f}", survey.km),
                              signed_text(survey.score.bias),
                              number_text(survey.score.rmse, 2)});
    }
    std::string when;
    if (!report.passes_span.empty()) {
        when += "<p>Cars drove there " + unbroken(escaped(report.passes_span)) + "; surveyed " +
                (report.references_span.empty() ? "on days that are not known"
                                                : unbroken(escaped(report.references_span))) +
                ". " + escaped(report.gap) + "</p>\n";
    }
    return "<section>\n<h2>References</h2>\n" + when + html_of(table) + "</section>\n";
}

std::string tracks_tables(const ComparedPieces& pieces) {
    std::string html;
    if (pieces.left.all.pieces > 0) {
        html += scores_table("Left track, where both know it", pieces.left);
    }
    if (pieces.right.all.pieces > 0) {
        html += scores_table("Right track, where both know it", pieces.right);
    }
    return html;
}

std::string pieces_section(const ReferenceReport& report) {
    const auto pairs = pairs_of(report.hundreds.pairs, ComparedSide::headline);
    const auto short_pairs = pairs_of(report.segments.pairs, ComparedSide::headline);
    if (report.surveys.empty()) {
        return {};
    }
    if (pairs.empty() && short_pairs.empty()) {
        return "<section>\n<h2>Cars beside references</h2>\n<p>No car has driven where the "
               "references were measured.</p>\n</section>\n";
    }
    std::string html = "<section>\n<h2>Cars beside references</h2>\n<p>Bias is cars less "
                       "reference. The interval is that of the cars alone: what the reference "
                       "itself is off by counts against it.</p>\n";
    if (!pairs.empty()) {
        html += scatter_svg(pairs) + differences_svg(pairs);
        html += scores_table("Pieces of 100 m", report.hundreds.headline);
        html += tracks_tables(report.hundreds);
    }
    if (!short_pairs.empty()) {
        html += scores_table(fmt::format("Segments of {:g} m", report.segment_length_m),
                             report.segments.headline);
        html += tracks_tables(report.segments);
    } else {
        html += "<p>Rows of these surveys are much longer than a segment: single segments are not "
                "compared.</p>\n";
    }
    return html + "</section>\n";
}

std::vector<std::string> row_of(const ComparedControl& control) {
    const bool driven = control.cars.length_m > 0;
    std::string drift = driven ? fmt::format("too few months ({})", control.months) : no_value;
    if (control.drift) {
        drift = fmt::format("{:+.2f} ± {:.2f} a year{}",
                            control.drift->per_year,
                            z_of_90_percent * control.drift->sd_per_year,
                            control.drift->significant ? ", <b>drifts</b>" : "");
    }
    return {breakable(control.name),
            iri_text(control.known),
            driven ? iri_text(control.cars.iri) : no_value,
            driven ? fmt::format("{:+.2f} ± {:.2f}", control.off, z_of_90_percent * control.off_sd)
                   : no_value,
            drift};
}

std::string controls_section(const ReferenceReport& report) {
    if (report.controls.empty()) {
        return {};
    }
    HtmlTable table{
        "Control sections, IRI in mm/m, 90 % intervals",
        {{"Section"}, {"Known", true}, {"Cars", true}, {"Off by", true}, {"Drift", true}},
        {}};
    for (const auto& control : report.controls) {
        table.rows.push_back(row_of(control));
    }
    return "<section>\n<h2>Control sections</h2>\n<p>Stretches of known roughness that do not "
           "enter the map. A drift is significant where the trend of the difference, month by "
           "month, is over twice its standard deviation.</p>\n" +
           html_of(table) + "</section>\n";
}

std::string head_of(const ReferenceReport& report) {
    const auto& all = report.hundreds.headline.all;
    std::string html = "<header>\n<h1>" + breakable(report.title) + "</h1>\n";
    if (all.pieces > 0) {
        html += fmt::format("<p>Over {} of 100&nbsp;m the cars alone are off by {} mm/m on average "
                            "and {} (RMSE) in a piece; {} of the references lie within their "
                            "90&nbsp;% interval.</p>\n",
                            count_text(all.pieces, "piece", "pieces"),
                            signed_text(all.bias),
                            number_text(all.rmse, 2),
                            percent_text(all.coverage, 1));
    }
    return html + "</header>\n";
}

} // namespace

std::string reference_html(const ReferenceReport& report) {
    auto html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
        "style-src 'unsafe-inline'\">\n"
        "<meta name=\"generator\" content=\"Macadam\">\n<title>{}</title>\n<style>\n{}</style>\n"
        "</head>\n<body>\n",
        escaped(report.title),
        report_style());
    html += head_of(report) + "<main>\n";
    html += surveys_section(report);
    html += pieces_section(report);
    html += controls_section(report);
    return html + "</main>\n</body>\n</html>\n";
}

} // namespace macadam
