#include "app/report/reference_output.hpp"

#include "app/cli/terminal_escape.hpp"
#include "app/cli/text_table.hpp"
#include "estimator/common/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <vector>

namespace macadam {
namespace {

/// Formats a period: "2026-01-03 to 2026-05-11"; "" = not dated.
std::string span_of(const ComparedDays& days) {
    return Localisation{}.period(days.first, days.last);
}

Cell unless_empty(const std::string& text) {
    return text.empty() ? Cell{} : Cell{text};
}

// -------------------------------------------------------------------------------------- scores

struct Level {
    std::string name; ///< in tables
    SurveyScore score;
};

std::string bias_words(const Level& level, UnitSystem units) {
    const auto scale = iri_scale(2, units);
    return std::isnan(level.score.bias)
               ? "-"
               : fmt::format("{:+.{}f}", scale.of_mm_per_m * level.score.bias, scale.decimals);
}

// clang-format off
const Columns<Level> range_columns{
    {"from", as::iri(0), [](auto& r) { return r.score.from_mm_per_m; }},
    {"to", as::iri(0), [](auto& r) { return r.score.to_mm_per_m; }},
};

Columns<Level> score_columns(std::string_view heading, UnitSystem units) {
    return in_units<Level>({
        {"", as::text, [](auto& r) { return r.name; }, {heading, "{:<18}"}},
        {"pieces", as::integer, [](auto& r) { return r.score.pieces; }, {"pieces", "{:>8}"}},
        {"mean_reference", as::iri(4), [](auto& r) { return r.score.mean_survey; },
         {"reference", "{:>10}", 2}},
        {"mean_cars", as::iri(4), [](auto& r) { return r.score.mean_trip; }, {"cars", "{:>8}", 2}},
        {"bias", as::iri(4), [](auto& r) { return r.score.bias; }},
        {"", as::text, [units](auto& r) { return bias_words(r, units); }, {"bias", "{:>8}"}},
        {"sd", as::iri(4), [](auto& r) { return r.score.sd; }},
        {"rmse", as::iri(4), [](auto& r) { return r.score.rmse; }, {"RMSE", "{:>8}", 2}},
        {"correlation", as::real(4), [](auto& r) { return r.score.correlation; },
         {"corr.", "{:>8}", 2}},
        {"coverage_90", as::real(4), [](auto& r) { return r.score.coverage; }},
        {"", as::real(0, "%"), [](auto& r) { return 100 * r.score.coverage; }, {"in 90 %", "{:>9}"}},
    }, units);
}
// clang-format on

std::string json_of(const SurveyScore& score, UnitSystem units) {
    return json_object(score_columns("", units), {"", score}).text();
}

std::vector<Level> levels_of(const ReferenceScores& scores, UnitSystem units) {
    const auto words = [&](double mm_per_m) {
        return units == UnitSystem::us
                   ? fmt::format("{:.0f}", iri_scale(0, units).of_mm_per_m * mm_per_m)
                   : fmt::format("{:g}", mm_per_m);
    };
    std::vector<Level> levels;
    for (const auto& score : scores.by_level) {
        levels.push_back(
            {fmt::format("{} to {}", words(score.from_mm_per_m), words(score.to_mm_per_m)), score});
    }
    return levels;
}

std::string json_of(const ReferenceScores& scores, UnitSystem units) {
    auto columns = in_units(range_columns, units);
    std::ranges::copy(score_columns("", units), std::back_inserter(columns));
    JsonObject object;
    object.add("all", JsonRaw{json_of(scores.all, units)})
        .add("by_level", JsonRaw{json_rows(columns, levels_of(scores, units))});
    return object.text();
}

std::string json_of(const ComparedPieces& pieces, UnitSystem units) {
    JsonObject object;
    object.add("iri", JsonRaw{json_of(pieces.headline, units)})
        .add("left", JsonRaw{json_of(pieces.left, units)})
        .add("right", JsonRaw{json_of(pieces.right, units)});
    return object.text();
}

std::string
scores_text(const std::string& heading, const ReferenceScores& scores, UnitSystem units) {
    if (scores.all.pieces == 0) {
        return {};
    }
    auto levels = levels_of(scores, units);
    levels.push_back({"all", scores.all});
    return fmt::format("\n{}", table_text(score_columns(heading, units), levels));
}

std::string pieces_text(double length_m, const ComparedPieces& pieces, UnitSystem units) {
    const auto heading = fmt::format(
        "{}, {}", length_words(length_m, units), units == UnitSystem::us ? "in/mi" : "mm/m");
    return scores_text(heading, pieces.headline, units) +
           scores_text(heading + ", left", pieces.left, units) +
           scores_text(heading + ", right", pieces.right, units);
}

// --------------------------------------------------------------- surveys, control sections, pairs

Cell of_cars(const ComparedControl& control, double value) {
    return control.cars.length_m > 0 ? Cell{value} : Cell{};
}

Cell difference_of(const ComparedControl& control, double sds) {
    return of_cars(control, control.off + sds * control.off_sd);
}

template <typename Member>
Cell of_drift(const ComparedControl& control, Member member) {
    return control.drift ? Cell{(*control.drift).*member} : Cell{};
}

struct PairRow {
    const char* level;
    const ReferenceReport& report;
    const ReferencePair& pair;
};

Cell of_side(const std::optional<SurveyPair>& side, double SurveyPair::*value) {
    return side ? Cell{(*side).*value} : Cell{};
}

// clang-format off
Columns<ComparedSurvey> compared_survey_columns(UnitSystem units) {
    return in_units<ComparedSurvey>({
    {"name", as::text, [](auto& r) { return r.name; }},
    {"date", as::day, [](auto& r) { return unless_empty(r.day); }},
    {"accuracy", as::real(4), [](auto& r) { return r.relative_sd; }},
    {"row_m", as::metres(2), [](auto& r) { return r.row_m; }},
    {"segments", as::integer, [](auto& r) { return r.segments; }},
    {"km", as::real(3, "km"), [](auto& r) { return r.km; }},
    {"alone_km", as::real(3, "km"), [](auto& r) { return r.alone_km; }},
    {"hundred_metres", as::raw, [units](auto& r) { return json_of(r.score, units); }},
    }, units);
}

const Columns<ComparedControl> control_columns{
    {"name", as::text, [](auto& r) { return r.name; }},
    {"known_iri", as::iri(3), [](auto& r) { return r.known; }},
    {"iri", as::iri(3), [](auto& r) { return of_cars(r, r.cars.iri); }},
    {"difference", as::iri(3), [](auto& r) { return of_cars(r, r.off); }},
    {"difference_low", as::iri(3), [](auto& r) { return difference_of(r, -normal_interval_90); }},
    {"difference_high", as::iri(3), [](auto& r) { return difference_of(r, normal_interval_90); }},
    {"months", as::integer, [](auto& r) { return r.months; }},
    {"drift_per_year", as::iri(4), [](auto& r) { return of_drift(r, &Drift::per_year); }},
    {"drift_sd_per_year", as::iri(4), [](auto& r) { return of_drift(r, &Drift::sd_per_year); }},
    {"drifts", as::truth, [](auto& r) { return of_drift(r, &Drift::significant); }},
};

const Columns<PairRow> pair_columns{
    {"pieces", as::text, [](auto& r) { return r.level; }},
    {"survey", as::text, [](auto& r) { return r.report.surveys[r.pair.survey].name; }},
    {"first_segment", as::text, [](auto& r) { return name_of(r.pair.first); }},
    {"last_segment", as::text, [](auto& r) { return name_of(r.pair.last); }},
    {"length_m", as::metres(2), [](auto& r) { return r.pair.length_m; }},
    {"passes", as::integer, [](auto& r) { return r.pair.passes; }},
    {"reference", as::iri(3), [](auto& r) { return r.pair.headline.survey; }},
    {"reference_sd", as::iri(3), [](auto& r) { return r.pair.reference_sd; }},
    {"iri", as::iri(3), [](auto& r) { return r.pair.headline.trip; }},
    {"iri_low", as::iri(3), [](auto& r) { return r.pair.headline.low; }},
    {"iri_high", as::iri(3), [](auto& r) { return r.pair.headline.high; }},
    {"difference", as::iri(3),
     [](auto& r) { return r.pair.headline.trip - r.pair.headline.survey; }},
    {"reference_left", as::iri(3), [](auto& r) { return of_side(r.pair.left, &SurveyPair::survey); }},
    {"iri_left", as::iri(3), [](auto& r) { return of_side(r.pair.left, &SurveyPair::trip); }},
    {"reference_right", as::iri(3), [](auto& r) { return of_side(r.pair.right, &SurveyPair::survey); }},
    {"iri_right", as::iri(3), [](auto& r) { return of_side(r.pair.right, &SurveyPair::trip); }},
    {"days_after", as::real(1, "d"), [](auto& r) { return r.pair.days_after; }},
};
// clang-format on

// ---------------------------------------------------------------------------------------- text

std::string surveys_text(const ReferenceReport& report, UnitSystem units) {
    std::string text;
    for (const auto& survey : report.surveys) {
        text += fmt::format("reference   '{}', {}: {} in rows of {}, accurate to "
                            "{:g} %; {} of it not driven\n",
                            printable_name(survey.name),
                            survey.day.empty() ? "undated" : survey.day,
                            km_words(survey.km, 2, units),
                            length_words(std::round(survey.row_m), units),
                            100 * survey.relative_sd,
                            km_words(survey.alone_km, 2, units));
    }
    if (const auto span = span_of(report.passed); !span.empty()) {
        text += fmt::format("passes      {}\n", span);
    }
    const auto gap = days_after_text(report, Localisation{});
    return gap.empty() ? text : text + gap + "\n";
}

std::string controls_text(const ReferenceReport& report, UnitSystem units) {
    const auto [factor, decimals] = iri_scale(2, units);
    std::string text;
    for (const auto& control : report.controls) {
        text += fmt::format("\ncontrol     '{}': known {:.{}f}",
                            printable_name(control.name),
                            factor * control.known,
                            decimals);
        if (control.cars.length_m <= 0) {
            text += ", no pass yet";
            continue;
        }
        text += fmt::format(", cars {:.{}f}, bias {:+.{}f} ± {:.{}f}",
                            factor * control.cars.iri,
                            decimals,
                            factor * control.off,
                            decimals,
                            factor * normal_interval_90 * control.off_sd,
                            decimals);
        if (control.drift) {
            text += fmt::format(", {:+.{}f} ± {:.{}f} a year{}",
                                factor * control.drift->per_year,
                                decimals,
                                factor * normal_interval_90 * control.drift->sd_per_year,
                                decimals,
                                control.drift->significant ? ": DRIFTS" : "");
        }
    }
    return text.empty() ? text : text + "\n";
}

} // namespace

std::string reference_json(const ReferenceReport& report, UnitSystem units) {
    // clang-format off
    const Columns<ReferenceReport> columns{
        {"surveys", as::raw,
         [units](auto& r) { return json_rows(compared_survey_columns(units), r.surveys); }},
        {"passes_span", as::text, [](auto& r) { return unless_empty(span_of(r.passed)); }},
        {"references_span", as::text, [](auto& r) { return unless_empty(span_of(r.surveyed)); }},
        {"segment_length_m", as::metres(2), [](auto& r) { return r.segment_length_m; }},
        {"segments", as::raw, [units](auto& r) { return json_of(r.segments, units); }},
        {"hundred_metres", as::raw, [units](auto& r) { return json_of(r.hundreds, units); }},
        {"control_sections", as::raw,
         [units](auto& r) { return json_rows(in_units(control_columns, units), r.controls); }},
    };
    // clang-format on
    return json_object(in_units(columns, units), report).text() + "\n";
}

std::string reference_csv(const ReferenceReport& report, UnitSystem units) {
    const auto columns = in_units(pair_columns, units);
    auto csv = csv_header(columns);
    for (const auto& pair : report.segments.pairs) {
        csv += csv_line(columns, {"segment", report, pair});
    }
    for (const auto& pair : report.hundreds.pairs) {
        csv += csv_line(columns, {"100m", report, pair});
    }
    return csv;
}

std::string reference_text(const ReferenceReport& report, UnitSystem units) {
    return surveys_text(report, units) +
           pieces_text(report.segment_length_m, report.segments, units) +
           pieces_text(100, report.hundreds, units) + controls_text(report, units) +
           "\n"
           "bias: cars minus reference; the interval is that of the cars\n";
}

} // namespace macadam
