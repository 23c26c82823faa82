#include "render/report/reference_page.hpp"

#include "render/report/reference_figures.hpp"
#include "render/report/report.hpp"

#include <fmt/format.h>

#include <cmath>

namespace macadam {

using namespace document;

namespace {

constexpr const char* no_value = "–";
constexpr double z_of_90_percent = 1.645;
const Wording wording{};

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

std::vector<Cell> cells_of(const std::string& name, const SurveyScore& score) {
    return {name,
            wording.count(score.pieces),
            number_text(score.mean_survey, 2),
            number_text(score.mean_trip, 2),
            signed_text(score.bias),
            number_text(score.rmse, 2),
            number_text(score.correlation, 2),
            std::isnan(score.coverage) ? no_value : wording.percent(score.coverage, 1)};
}

Table scores_table(const std::string& caption, const ReferenceScores& scores) {
    Table table{caption,
                {{"Reference, mm/m"},
                 {"Pieces", true},
                 {"Reference", true},
                 {"Cars", true},
                 {"Bias", true},
                 {"RMSE", true},
                 {"Correlation", true, true},
                 {"In the 90\u00A0% interval", true}},
                {}};
    for (const auto& score : scores.by_level) {
        table.rows.push_back(cells_of(level_text(score), score));
    }
    table.rows.push_back(cells_of("All", scores.all));
    table.sum = true;
    return table;
}

DocumentSection surveys_section(const ReferenceReport& report) {
    Table table{"Surveys, IRI in mm/m; scores of pieces of 100 m",
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
        table.rows.push_back({(survey.name),
                              survey.day.empty() ? "not known" : survey.day,
                              fmt::format("{:g} %", 100 * survey.relative_sd),
                              fmt::format("{:.0f}", survey.row_m),
                              wording.count(survey.segments),
                              fmt::format("{:.2f}", survey.km),
                              signed_text(survey.score.bias),
                              number_text(survey.score.rmse, 2)});
    }
    DocumentSection section{"References", {}};
    if (!report.passes_span.empty()) {
        section.blocks.emplace_back(Paragraph{std::vector<Span>{
            {"Cars drove there "},
            {report.passes_span, SpanLook::plain, true},
            {"; surveyed "},
            {report.references_span.empty() ? "on days that are not known" : report.references_span,
             SpanLook::plain,
             true},
            {". " + report.gap}}});
    }
    section.blocks.emplace_back(std::move(table));
    return section;
}

void add_tracks(DocumentSection& section, const ComparedPieces& pieces) {
    if (pieces.left.all.pieces > 0) {
        section.blocks.emplace_back(scores_table("Left track, where both know it", pieces.left));
    }
    if (pieces.right.all.pieces > 0) {
        section.blocks.emplace_back(scores_table("Right track, where both know it", pieces.right));
    }
}

DocumentSection pieces_section(const ReferenceReport& report) {
    const auto pairs = pairs_of(report.hundreds.pairs, ComparedSide::headline);
    const auto short_pairs = pairs_of(report.segments.pairs, ComparedSide::headline);
    DocumentSection section{"Cars beside references", {}};
    if (pairs.empty() && short_pairs.empty()) {
        section.blocks.emplace_back(
            Paragraph{"No car has driven where the references were measured."});
        return section;
    }
    section.blocks.emplace_back(
        Paragraph{"Bias is cars less reference. The interval is that of the cars alone: what the "
                  "reference itself is off by counts against it."});
    if (!pairs.empty()) {
        section.blocks.emplace_back(scatter_drawing(pairs));
        section.blocks.emplace_back(differences_drawing(pairs));
        section.blocks.emplace_back(scores_table("Pieces of 100 m", report.hundreds.headline));
        add_tracks(section, report.hundreds);
    }
    if (!short_pairs.empty()) {
        section.blocks.emplace_back(scores_table(
            fmt::format("Segments of {:g} m", report.segment_length_m), report.segments.headline));
        add_tracks(section, report.segments);
    } else {
        section.blocks.emplace_back(Paragraph{"Rows of these surveys are much longer than a "
                                              "segment: single segments are not compared."});
    }
    return section;
}

std::vector<Cell> row_of(const ComparedControl& control) {
    const bool driven = control.cars.length_m > 0;
    Rich drift = driven ? fmt::format("too few months ({})", control.months) : no_value;
    if (control.drift) {
        drift = fmt::format("{:+.2f} ± {:.2f} a year",
                            control.drift->per_year,
                            z_of_90_percent * control.drift->sd_per_year);
        if (control.drift->significant) {
            drift.spans.push_back({", "});
            drift.spans.push_back({"drifts", SpanLook::strong});
        }
    }
    return {(control.name),
            wording.iri(control.known),
            driven ? wording.iri(control.cars.iri) : no_value,
            driven ? fmt::format("{:+.2f} ± {:.2f}", control.off, z_of_90_percent * control.off_sd)
                   : no_value,
            drift};
}

DocumentSection controls_section(const ReferenceReport& report) {
    Table table{"Control sections, IRI in mm/m, 90 % intervals",
                {{"Section"}, {"Known", true}, {"Cars", true}, {"Off by", true}, {"Drift", true}},
                {}};
    for (const auto& control : report.controls) {
        table.rows.push_back(row_of(control));
    }
    return {"Control sections",
            {Paragraph{"Stretches of known roughness that do not enter the map. A drift is "
                       "significant where the trend of the difference, month by month, is over "
                       "twice its standard deviation."},
             table}};
}

std::string subtitle_of(const ReferenceReport& report) {
    const auto& all = report.hundreds.headline.all;
    return all.pieces == 0
               ? ""
               : fmt::format(
                     "Over {} {} of 100\u00A0m the cars alone are off by {} mm/m on average "
                     "and {} (RMSE) in a piece; {} of the references lie within their "
                     "90\u00A0% interval.",
                     wording.count(all.pieces),
                     all.pieces == 1 ? "piece" : "pieces",
                     signed_text(all.bias),
                     number_text(all.rmse, 2),
                     wording.percent(all.coverage, 1));
}

} // namespace

Document reference_document(const ReferenceReport& report) {
    Document document{.language = "en",
                      .title = report.title,
                      .subtitle = subtitle_of(report),
                      .running_head = report.title,
                      .page_of = std::string{find_message(*wording.language, "page")->text},
                      .day = "",
                      .keys = {},
                      .sections = {},
                      .end = {}};
    if (!report.surveys.empty()) {
        document.sections.push_back(surveys_section(report));
        document.sections.push_back(pieces_section(report));
    }
    if (!report.controls.empty()) {
        document.sections.push_back(controls_section(report));
    }
    return document;
}

std::string reference_html(const ReferenceReport& report) {
    return html_of(reference_document(report));
}

} // namespace macadam
