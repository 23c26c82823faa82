#include "render/report/reference_page.hpp"

#include "render/report/common_parts.hpp"

#include "estimator/common/statistics.hpp"
#include "render/report/reference_figures.hpp"
#include "render/report/report.hpp"

#include <fmt/format.h>

#include <cmath>

namespace macadam {

using namespace document;

namespace {

constexpr const char* no_value = "–";

std::string iri_text(const Localisation& say, double mm_per_m) {
    return std::isnan(mm_per_m) ? no_value : say.iri(mm_per_m);
}

std::string change_text(const Localisation& say, double mm_per_m) {
    return std::isnan(mm_per_m) ? no_value : say.iri_change(mm_per_m);
}

Values in_its_unit(const Localisation& say) {
    return {{"unit", std::string{say.iri_unit()}}};
}

std::vector<Cell>
cells_of(const Localisation& say, const std::string& name, const SurveyScore& score) {
    return {name,
            say.count(score.pieces),
            iri_text(say, score.mean_survey),
            iri_text(say, score.mean_trip),
            change_text(say, score.bias),
            iri_text(say, score.rmse),
            std::isnan(score.correlation) ? no_value : say.number(score.correlation, 2),
            std::isnan(score.coverage) ? no_value : say.percent(score.coverage, 1)};
}

Table scores_table(const Localisation& say,
                   const std::string& caption,
                   const ReferenceScores& scores) {
    Table table{caption,
                {{say("reference.column.level", in_its_unit(say))},
                 {say("reference.column.pieces"), true},
                 {say("reference.column.reference"), true},
                 {say("column.cars"), true},
                 {say("reference.column.bias"), true},
                 {"RMSE", true},
                 {say("reference.column.correlation"), true, true},
                 {say("reference.column.coverage"), true}},
                {}};
    for (const auto& score : scores.by_level) {
        table.rows.push_back(cells_of(say, level_text(say, score), score));
    }
    table.rows.push_back(cells_of(say, say("all"), scores.all));
    table.sum = true;
    return table;
}

/// Returns "12 days after", in the report's language.
std::string days_text(const Localisation& say, double days) {
    constexpr double days_a_month = 30.44, days_a_year = 365.25;
    const double far = std::abs(days);
    const auto counted = [&](const char* key, double count) {
        return say.counted(key, static_cast<std::size_t>(std::lround(count)));
    };
    const auto length = far < 90 ? counted("reference.days", far)
                        : far < 730
                            ? counted("reference.months", far / days_a_month)
                            : say("reference.years", {{"count", say.number(far / days_a_year, 1)}});
    return say(days < 0 ? "reference.before" : "reference.after", {{"length", length}});
}

Paragraph days_paragraph(const ReferenceReport& report) {
    const auto& say = report.wording;
    const auto surveyed = say.period(report.surveyed.first, report.surveyed.last);
    const auto gap = days_after_text(report, say);
    return {std::vector<Span>{
        {say("reference.driven") + " "},
        {say.period(report.passed.first, report.passed.last), SpanLook::plain, true},
        {say("reference.surveyed") + " "},
        {surveyed.empty() ? say("reference.days_not_known") : surveyed, SpanLook::plain, true},
        {gap.empty() ? "." : ". " + gap}}};
}

DocumentSection surveys_section(const ReferenceReport& report) {
    const auto& say = report.wording;
    Table table{say("reference.surveys.caption", in_its_unit(say)),
                {{say("reference.column.survey")},
                 {say("reference.column.measured")},
                 {say("reference.column.good_to"), true, true},
                 {say("reference.column.rows_m"), true, true},
                 {say("column.segments"), true, true},
                 {say.long_unit(), true},
                 {say("reference.column.bias"), true},
                 {"RMSE", true}},
                {}};
    for (const auto& survey : report.surveys) {
        table.rows.push_back({(survey.name),
                              survey.day.empty() ? say("reference.not_known") : say.day(survey.day),
                              say.shortest(100 * survey.relative_sd) + " %",
                              say.short_length(survey.row_m),
                              say.count(survey.segments),
                              say.number(say.long_length(1000 * survey.km), 2),
                              change_text(say, survey.score.bias),
                              iri_text(say, survey.score.rmse)});
    }
    DocumentSection section{say("reference.surveys"), {}};
    if (!report.passed.first.empty()) {
        section.blocks.emplace_back(days_paragraph(report));
    }
    section.blocks.emplace_back(std::move(table));
    return section;
}

void add_tracks(DocumentSection& section, const Localisation& say, const ComparedPieces& pieces) {
    if (pieces.left.all.pieces > 0) {
        section.blocks.emplace_back(scores_table(say, say("reference.pieces.left"), pieces.left));
    }
    if (pieces.right.all.pieces > 0) {
        section.blocks.emplace_back(scores_table(say, say("reference.pieces.right"), pieces.right));
    }
}

DocumentSection pieces_section(const ReferenceReport& report) {
    const auto& say = report.wording;
    const auto pairs = pairs_of(report.hundreds.pairs, ComparedSide::headline);
    const auto short_pairs = pairs_of(report.segments.pairs, ComparedSide::headline);
    DocumentSection section{say("reference.pieces"), {}};
    if (pairs.empty() && short_pairs.empty()) {
        section.blocks.emplace_back(Paragraph{say("reference.pieces.none")});
        return section;
    }
    section.blocks.emplace_back(Paragraph{say("reference.pieces.about")});
    if (!pairs.empty()) {
        section.blocks.emplace_back(scatter_drawing(pairs, say));
        section.blocks.emplace_back(differences_drawing(pairs, say));
        section.blocks.emplace_back(
            scores_table(say, say("reference.pieces.hundreds"), report.hundreds.headline));
        add_tracks(section, say, report.hundreds);
    }
    if (!short_pairs.empty()) {
        section.blocks.emplace_back(scores_table(
            say,
            say("reference.pieces.segments",
                {{"length",
                  say.unit == IriUnit::in_per_mi ? say.short_length(report.segment_length_m)
                                                 : say.shortest(report.segment_length_m)}}),
            report.segments.headline));
        add_tracks(section, say, report.segments);
    } else {
        section.blocks.emplace_back(Paragraph{say("reference.pieces.too_long")});
    }
    return section;
}

RichText drift_text(const Localisation& say, const ComparedControl& control) {
    if (!control.drift) {
        return control.cars.length_m > 0
                   ? say("reference.drift.too_few", {{"count", say.count(control.months)}})
                   : no_value;
    }
    RichText text = say("reference.drift.a_year",
                        {{"drift", say.iri_change(control.drift->per_year)},
                         {"interval", say.iri(normal_interval_90 * control.drift->sd_per_year)}});
    if (control.drift->significant) {
        text.spans.push_back({", "});
        text.spans.push_back({say("reference.drift.drifts"), SpanLook::strong});
    }
    return text;
}

std::vector<Cell> row_of(const Localisation& say, const ComparedControl& control) {
    const bool driven = control.cars.length_m > 0;
    return {(control.name),
            say.iri(control.known),
            driven ? say.iri(control.cars.iri) : no_value,
            driven ? fmt::format("{} ± {}",
                                 say.iri_change(control.off),
                                 say.iri(normal_interval_90 * control.off_sd))
                   : no_value,
            drift_text(say, control)};
}

DocumentSection controls_section(const ReferenceReport& report) {
    const auto& say = report.wording;
    Table table{say("reference.controls.caption", in_its_unit(say)),
                {{say("column.section")},
                 {say("reference.column.known"), true},
                 {say("column.cars"), true},
                 {say("reference.column.off"), true},
                 {say("reference.column.drift"), true}},
                {}};
    for (const auto& control : report.controls) {
        table.rows.push_back(row_of(say, control));
    }
    return {say("reference.controls"), {Paragraph{say("reference.controls.about")}, table}};
}

std::string subtitle_of(const ReferenceReport& report) {
    const auto& say = report.wording;
    const auto& all = report.hundreds.headline.all;
    return all.pieces == 0 ? ""
                           : say.counted("reference.subtitle",
                                         all.pieces,
                                         {{"bias", change_text(say, all.bias)},
                                          {"unit", std::string{say.iri_unit()}},
                                          {"rmse", iri_text(say, all.rmse)},
                                          {"coverage", say.percent(all.coverage, 1)}});
}

} // namespace

std::string days_after_text(const ReferenceReport& report, const Localisation& say) {
    if (!report.days_after) {
        return {};
    }
    const auto& [least, middle, most] = *report.days_after;
    return say("reference.gap",
               {{"middle", days_text(say, middle)},
                {"least", days_text(say, least)},
                {"most", days_text(say, most)}});
}

Document reference_document(const ReferenceReport& report) {
    const auto& language = *report.wording.language;
    Document document{.language = language.code,
                      .title = report.title,
                      .subtitle = subtitle_of(report),
                      .running_head = report.title,
                      .page_of = *find_message(language, "page"),
                      .day = "",
                      .keys = {},
                      .sections = {},
                      .end = {},
                      .words = page_words(report.wording, false)};
    if (!report.surveys.empty()) {
        document.sections.push_back(surveys_section(report));
        document.sections.push_back(pieces_section(report));
    }
    if (!report.controls.empty()) {
        document.sections.push_back(controls_section(report));
    }
    if (report.is_own) {
        document.sections.push_back(
            {report.wording("data"), {Paragraph{report.wording("data.own")}}});
    }
    return document;
}

std::string reference_html(const ReferenceReport& report) {
    return html_of(reference_document(report));
}

} // namespace macadam
