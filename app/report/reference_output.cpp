#include "app/report/reference_output.hpp"

#include "app/cli/terminal_escape.hpp"
#include "storage/exports/export.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <cmath>

namespace macadam {
namespace {

constexpr double z_of_90_percent = 1.645;

/// Formats a period: "2026-01-03 to 2026-05-11"; "" = not dated.
std::string span_of(const ComparedDays& days) {
    return Localisation{}.period(days.first, days.last);
}

// ---------------------------------------------------------------------------------------- JSON

std::string json_of(const SurveyScore& score, bool with_level) {
    JsonObject object;
    if (with_level) {
        object.add("from", json_number(score.from_mm_per_m, 0))
            .add("to", json_number(score.to_mm_per_m, 0));
    }
    object.add("pieces", static_cast<std::int64_t>(score.pieces))
        .add("mean_reference", json_number(score.mean_survey, 4))
        .add("mean_cars", json_number(score.mean_trip, 4))
        .add("bias", json_number(score.bias, 4))
        .add("sd", json_number(score.sd, 4))
        .add("rmse", json_number(score.rmse, 4))
        .add("correlation", json_number(score.correlation, 4))
        .add("coverage_90", json_number(score.coverage, 4));
    return object.text();
}

std::string json_of(const ReferenceScores& scores) {
    std::vector<std::string> levels;
    for (const auto& score : scores.by_level) {
        levels.push_back(json_of(score, true));
    }
    JsonObject object;
    object.add("all", JsonRaw{json_of(scores.all, false)})
        .add("by_level", JsonRaw{json_array(levels)});
    return object.text();
}

std::string json_of(const ComparedPieces& pieces) {
    JsonObject object;
    object.add("iri", JsonRaw{json_of(pieces.headline)})
        .add("left", JsonRaw{json_of(pieces.left)})
        .add("right", JsonRaw{json_of(pieces.right)});
    return object.text();
}

JsonValue unless_empty(const std::string& text) {
    return text.empty() ? JsonValue{nullptr} : JsonValue{text};
}

std::string json_of(const ComparedSurvey& survey) {
    JsonObject object;
    object.add("name", survey.name)
        .add("date", unless_empty(survey.day))
        .add("accuracy", JsonNumber{survey.relative_sd, 4})
        .add("row_m", JsonNumber{survey.row_m, 2})
        .add("segments", static_cast<std::int64_t>(survey.segments))
        .add("km", JsonNumber{survey.km, 3})
        .add("alone_km", JsonNumber{survey.alone_km, 3})
        .add("hundred_metres", JsonRaw{json_of(survey.score, false)});
    return object.text();
}

std::string json_of(const ComparedControl& control) {
    const auto of_cars = [&](double value) {
        return control.cars.length_m > 0 ? json_number(value, 3) : JsonValue{nullptr};
    };
    const auto of_drift = [&](double Drift::*value) {
        return control.drift ? json_number((*control.drift).*value, 4) : JsonValue{nullptr};
    };
    JsonObject object;
    object.add("name", control.name)
        .add("known_iri", json_number(control.known, 3))
        .add("iri", of_cars(control.cars.iri))
        .add("difference", of_cars(control.off))
        .add("difference_low", of_cars(control.off - z_of_90_percent * control.off_sd))
        .add("difference_high", of_cars(control.off + z_of_90_percent * control.off_sd))
        .add("months", static_cast<std::int64_t>(control.months))
        .add("drift_per_year", of_drift(&Drift::per_year))
        .add("drift_sd_per_year", of_drift(&Drift::sd_per_year))
        .add("drifts", control.drift ? JsonValue{control.drift->significant} : JsonValue{nullptr});
    return object.text();
}

template <typename Values>
std::string array_of(const Values& values) {
    std::vector<std::string> objects;
    for (const auto& value : values) {
        objects.push_back(json_of(value));
    }
    return json_array(objects);
}

// ----------------------------------------------------------------------------------------- CSV

std::string cell(const std::optional<double>& value) {
    return value && !std::isnan(*value) ? fmt::format("{:.3f}", *value) : "";
}

std::optional<double> part(const std::optional<SurveyPair>& pair, double SurveyPair::*value) {
    return pair ? std::optional{(*pair).*value} : std::nullopt;
}

std::string
csv_rows(const ReferenceReport& report, const ComparedPieces& pieces, const char* level) {
    std::string rows;
    for (const auto& pair : pieces.pairs) {
        rows += fmt::format("{},{},{},{},{:.2f},{},{},{},{},{},{},{},{},{},{},{},{}\n",
                            level,
                            csv_text(report.surveys[pair.survey].name),
                            csv_text(name_of(pair.first)),
                            csv_text(name_of(pair.last)),
                            pair.length_m,
                            pair.passes,
                            cell(pair.headline.survey),
                            cell(pair.reference_sd),
                            cell(pair.headline.trip),
                            cell(pair.headline.low),
                            cell(pair.headline.high),
                            cell(pair.headline.trip - pair.headline.survey),
                            cell(part(pair.left, &SurveyPair::survey)),
                            cell(part(pair.left, &SurveyPair::trip)),
                            cell(part(pair.right, &SurveyPair::survey)),
                            cell(part(pair.right, &SurveyPair::trip)),
                            pair.days_after ? fmt::format("{:.1f}", *pair.days_after) : "");
    }
    return rows;
}

// ---------------------------------------------------------------------------------------- text

std::string number_text(double value, int decimals) {
    return std::isnan(value) ? std::string{"-"} : fmt::format("{:.{}f}", value, decimals);
}

std::string score_line(const std::string& name, const SurveyScore& score) {
    return fmt::format("{:<18}{:>8}{:>10}{:>8}{:>8}{:>8}{:>8}{:>9}\n",
                       name,
                       score.pieces,
                       number_text(score.mean_survey, 2),
                       number_text(score.mean_trip, 2),
                       std::isnan(score.bias) ? "-" : fmt::format("{:+.2f}", score.bias),
                       number_text(score.rmse, 2),
                       number_text(score.correlation, 2),
                       number_text(100 * score.coverage, 0));
}

std::string scores_text(const std::string& what, const ReferenceScores& scores) {
    if (scores.all.pieces == 0) {
        return {};
    }
    auto text = fmt::format("\n{:<18}{:>8}{:>10}{:>8}{:>8}{:>8}{:>8}{:>9}\n",
                            what,
                            "pieces",
                            "reference",
                            "cars",
                            "bias",
                            "RMSE",
                            "corr.",
                            "in 90 %");
    for (const auto& score : scores.by_level) {
        text +=
            score_line(fmt::format("{:g} to {:g}", score.from_mm_per_m, score.to_mm_per_m), score);
    }
    return text + score_line("all", scores.all);
}

std::string pieces_text(const std::string& what, const ComparedPieces& pieces) {
    return scores_text(what, pieces.headline) + scores_text(what + ", left", pieces.left) +
           scores_text(what + ", right", pieces.right);
}

std::string surveys_text(const ReferenceReport& report) {
    std::string text;
    for (const auto& survey : report.surveys) {
        text += fmt::format("reference   '{}', {}: {:.2f} km in rows of {:.0f} m, accurate to "
                            "{:g} %; {:.2f} km of it not driven\n",
                            printable_name(survey.name),
                            survey.day.empty() ? "undated" : survey.day,
                            survey.km,
                            survey.row_m,
                            100 * survey.relative_sd,
                            survey.alone_km);
    }
    if (const auto span = span_of(report.passed); !span.empty()) {
        text += fmt::format("passes      {}\n", span);
    }
    const auto gap = days_after_text(report, Localisation{});
    return gap.empty() ? text : text + gap + "\n";
}

std::string controls_text(const ReferenceReport& report) {
    std::string text;
    for (const auto& control : report.controls) {
        text += fmt::format(
            "\ncontrol     '{}': known {:.2f}", printable_name(control.name), control.known);
        if (control.cars.length_m <= 0) {
            text += ", no pass yet";
            continue;
        }
        text += fmt::format(", cars {:.2f}, bias {:+.2f} ± {:.2f}",
                            control.cars.iri,
                            control.off,
                            z_of_90_percent * control.off_sd);
        if (control.drift) {
            text += fmt::format(", {:+.2f} ± {:.2f} a year{}",
                                control.drift->per_year,
                                z_of_90_percent * control.drift->sd_per_year,
                                control.drift->significant ? ": DRIFTS" : "");
        }
    }
    return text.empty() ? text : text + "\n";
}

} // namespace

std::string reference_json(const ReferenceReport& report) {
    JsonObject object;
    object.add("surveys", JsonRaw{array_of(report.surveys)})
        .add("passes_span", unless_empty(span_of(report.passed)))
        .add("references_span", unless_empty(span_of(report.surveyed)))
        .add("segment_length_m", JsonNumber{report.segment_length_m, 2})
        .add("segments", JsonRaw{json_of(report.segments)})
        .add("hundred_metres", JsonRaw{json_of(report.hundreds)})
        .add("control_sections", JsonRaw{array_of(report.controls)});
    return object.text() + "\n";
}

std::string reference_csv(const ReferenceReport& report) {
    return "pieces,survey,first_segment,last_segment,length_m,passes,reference,reference_sd,iri,"
           "iri_low,iri_high,difference,reference_left,iri_left,reference_right,iri_right,"
           "days_after\n" +
           csv_rows(report, report.segments, "segment") + csv_rows(report, report.hundreds, "100m");
}

std::string reference_text(const ReferenceReport& report) {
    return surveys_text(report) +
           pieces_text(fmt::format("{:g} m, mm/m", report.segment_length_m), report.segments) +
           pieces_text("100 m, mm/m", report.hundreds) + controls_text(report) +
           "\n"
           "bias: cars minus reference; the interval is that of the cars\n";
}

} // namespace macadam
