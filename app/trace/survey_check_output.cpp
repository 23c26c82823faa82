
#include "app/trace/survey_check_output.hpp"

#include "render/report/document/line_chart.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

constexpr double z_of_90_percent = 1.645;
constexpr double same_place_m = 1; // between the end of a row and the beginning of the next

std::optional<double> headline_of(const AgainstRow& row) {
    return row.mean.mri_mm_per_m ? row.mean.mri_mm_per_m : row.mean.hri_mm_per_m;
}

std::pair<double, double> interval_of(const AgainstRow& row) {
    const double iri = headline_of(row).value_or(0);
    const double reach = z_of_90_percent * row.mean.sd_mm_per_m;
    return {std::max(0.0, iri - reach), iri + reach};
}

bool is_compared(const AgainstRow& row) {
    const bool whole =
        row.mean.validity == validity::ok || row.mean.validity == validity::indicative;
    return whole && row.survey_mm_per_m && headline_of(row);
}

/// Returns the columns, with values and decimals as in JSON.
std::vector<std::pair<std::string_view, JsonValue>> cells_of(const AgainstRow& row) {
    const auto iri = headline_of(row);
    const auto [low, high] = interval_of(row);
    const auto known = [&](double value) {
        return json_number(iri ? std::optional{value} : std::nullopt, 3);
    };
    const bool both = iri && row.survey_mm_per_m;
    return {
        {"survey_line", static_cast<std::int64_t>(row.survey.line)},
        {"pass", static_cast<std::int64_t>(row.pass.pass)},
        {"lat_deg", JsonNumber{row.survey.at.lat_deg, 7}},
        {"lon_deg", JsonNumber{row.survey.at.lon_deg, 7}},
        {"from_m", JsonNumber{row.pass.from_m, 2}},
        {"to_m", JsonNumber{row.pass.to_m, 2}},
        {"t_s", json_number(row.t_s, 3)},
        {"speed_mps", known(row.mean.speed_mps)},
        {"distance_m", JsonNumber{row.pass.distance_m, 2}},
        {"survey", json_number(row.survey_mm_per_m, 3)},
        {"survey_index",
         row.survey_mm_per_m ? JsonValue{std::string{row.survey_index}} : JsonValue{nullptr}},
        {"iri", json_number(iri, 3)},
        {"index",
         iri ? JsonValue{std::string{row.mean.mri_mm_per_m ? "MRI" : "HRI"}} : JsonValue{nullptr}},
        {"error", json_number(both ? std::optional{*iri - *row.survey_mm_per_m} : std::nullopt, 3)},
        {"iri_sd", known(row.mean.sd_mm_per_m)},
        {"iri_low", known(low)},
        {"iri_high", known(high)},
        {"survey_left", json_number(row.survey.left_mm_per_m, 3)},
        {"iri_left", json_number(row.mean.left_mm_per_m, 3)},
        {"survey_right", json_number(row.survey.right_mm_per_m, 3)},
        {"iri_right", json_number(row.mean.right_mm_per_m, 3)},
        {"validity", name_of_validity(row.mean.validity)}};
}

std::string cell_text(const JsonValue& value) {
    if (const auto* const number = std::get_if<JsonNumber>(&value)) {
        return fmt::format("{:.{}f}", number->value, number->decimals);
    }
    if (const auto* const whole = std::get_if<std::int64_t>(&value)) {
        return fmt::format("{}", *whole);
    }
    const auto* const words = std::get_if<std::string>(&value);
    return words ? *words : std::string{};
}

JsonObject json_object(const SurveyScore& score) {
    JsonObject object;
    object.add("pieces", static_cast<std::int64_t>(score.pieces))
        .add("mean_survey", json_number(score.mean_survey, 4))
        .add("mean_trip", json_number(score.mean_trip, 4))
        .add("bias", json_number(score.bias, 4))
        .add("sd", json_number(score.sd, 4))
        .add("rmse", json_number(score.rmse, 4))
        .add("correlation", json_number(score.correlation, 4))
        .add("coverage_90", json_number(score.coverage, 4));
    return object;
}

std::string number_text(double value, int decimals) {
    return std::isnan(value) ? std::string{"-"} : fmt::format("{:.{}f}", value, decimals);
}

std::string score_line(const std::string& name, const SurveyScore& score) {
    return fmt::format("{:<14}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>9}\n",
                       name,
                       score.pieces,
                       number_text(score.mean_survey, 2),
                       number_text(score.mean_trip, 2),
                       number_text(score.bias, 2),
                       number_text(score.sd, 2),
                       number_text(score.rmse, 2),
                       number_text(score.correlation, 2),
                       number_text(100 * score.coverage, 0));
}

std::string band_name(const SurveyScore& score) {
    return std::isinf(score.to_mm_per_m)
               ? fmt::format("{:g} and more", score.from_mm_per_m)
               : fmt::format("{:g} to {:g}", score.from_mm_per_m, score.to_mm_per_m);
}

/// Draws steps over the rows; a gap between rows begins a new line. The first line has the name.
std::vector<ChartLine> steps_along(std::span<const AgainstRow> rows,
                                   std::string name,
                                   ChartLine::Look look,
                                   double (*value)(const AgainstRow&)) {
    std::vector<ChartLine> lines;
    double end_m = 0;
    for (const auto& row : rows) {
        if (lines.empty() || std::abs(row.pass.from_m - end_m) > same_place_m) {
            lines.push_back({.name = std::exchange(name, ""), .x = {}, .y = {}, .look = look});
        }
        end_m = row.pass.to_m;
        for (const double at_m : {row.pass.from_m, row.pass.to_m}) {
            lines.back().x.push_back(at_m / 1000);
            lines.back().y.push_back(value(row));
        }
    }
    return lines;
}

double survey_of(const AgainstRow& row) {
    return *row.survey_mm_per_m;
}

double trip_of(const AgainstRow& row) {
    return *headline_of(row);
}

ChartPanel scatter_of(std::span<const SurveyPair> pairs) {
    ChartLine dots{.name = "a road section", .x = {}, .y = {}, .look = ChartLine::Look::dots};
    double most = 1;
    for (const auto& pair : pairs) {
        dots.x.push_back(pair.survey);
        dots.y.push_back(pair.trip);
        most = std::max({most, pair.survey, pair.trip});
    }
    return {.title = "Survey and trip",
            .x_label = "IRI of the survey, mm/m",
            .y_label = "IRI of the trip, mm/m",
            .lines = {{"alike", {0, most}, {0, most}, ChartLine::Look::faint}, std::move(dots)}};
}

} // namespace

std::vector<SurveyPair> compared_pairs(const Against& against) {
    std::vector<SurveyPair> pairs;
    for (const auto& row : against.rows) {
        if (is_compared(row)) {
            const auto [low, high] = interval_of(row);
            pairs.push_back({*row.survey_mm_per_m, *headline_of(row), low, high});
        }
    }
    return pairs;
}

std::string against_csv(const Against& against) {
    std::string csv;
    for (const auto& row : against.rows) {
        const auto cells = cells_of(row);
        if (csv.empty()) {
            for (const auto& [name, value] : cells) {
                csv += fmt::format("{}{}", csv.empty() ? "" : ",", name);
            }
            csv += '\n';
        }
        std::string line;
        for (const auto& [name, value] : cells) {
            line += line.empty() ? "" : ",";
            line += cell_text(value);
        }
        csv += line + '\n';
    }
    return csv;
}

std::string against_json(const Against& against) {
    std::vector<std::string> rows;
    for (const auto& row : against.rows) {
        JsonObject object;
        for (auto& [name, value] : cells_of(row)) {
            object.add(name, value);
        }
        rows.push_back(object.text());
    }
    const auto pairs = compared_pairs(against);
    std::vector<std::string> bands;
    for (const auto& score : scores_by_band(pairs)) {
        JsonObject band;
        band.add("from", JsonNumber{score.from_mm_per_m, 0})
            .add("to", json_number(score.to_mm_per_m, 0))
            .add("score", JsonRaw{json_object(score).text()});
        bands.push_back(band.text());
    }
    JsonObject object;
    object.add("survey_rows", static_cast<std::int64_t>(against.survey_rows))
        .add("met", static_cast<std::int64_t>(against.met))
        .add("score", JsonRaw{json_object(score_of(pairs)).text()})
        .add("bands", JsonRaw{json_array(bands)})
        .add("rows", JsonRaw{json_array(rows)});
    return object.text() + "\n";
}

std::string against_summary(const Against& against) {
    const auto pairs = compared_pairs(against);
    auto text =
        fmt::format("{} of the survey's {} rows were driven, {} times in all; {} compared\n",
                    against.met,
                    against.survey_rows,
                    against.rows.size(),
                    pairs.size());
    if (pairs.empty()) {
        return text;
    }
    text += fmt::format("{:<14}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>9}\n",
                        "IRI, mm/m",
                        "pieces",
                        "survey",
                        "trip",
                        "bias",
                        "sd",
                        "RMSE",
                        "corr.",
                        "in 90 %");
    text += score_line("all", score_of(pairs));
    for (const auto& score : scores_by_band(pairs)) {
        text += score_line(band_name(score), score);
    }
    return text;
}

std::string against_svg(const Against& against) {
    std::vector<AgainstRow> rows;
    std::ranges::copy_if(against.rows, std::back_inserter(rows), is_compared);
    if (rows.empty()) {
        return line_charts_svg({});
    }
    ChartPanel along{.title = "Along the trip",
                     .x_label = "travel, km",
                     .y_label = "IRI, mm/m",
                     .lines = steps_along(rows, "survey", ChartLine::Look::solid, survey_of)};
    std::ranges::move(steps_along(rows, "trip", ChartLine::Look::dashed, trip_of),
                      std::back_inserter(along.lines));
    const std::vector panels{std::move(along), scatter_of(compared_pairs(against))};
    return line_charts_svg(panels);
}

} // namespace macadam
