
#include "app/trace/survey_check_output.hpp"

#include "app/cli/row_writer.hpp"
#include "estimator/common/statistics.hpp"
#include "render/report/document/line_chart.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

constexpr double same_place_m = 1; // between the end of a row and the beginning of the next

std::optional<double> headline_of(const AgainstRow& row) {
    return row.mean.mri_mm_per_m ? row.mean.mri_mm_per_m : row.mean.hri_mm_per_m;
}

std::pair<double, double> interval_of(const AgainstRow& row) {
    const double iri = headline_of(row).value_or(0);
    const double reach = normal_interval_90 * row.mean.sd_mm_per_m;
    return {std::max(0.0, iri - reach), iri + reach};
}

bool is_compared(const AgainstRow& row) {
    const bool whole =
        row.mean.validity == validity::ok || row.mean.validity == validity::indicative;
    return whole && row.survey_mm_per_m && headline_of(row);
}

Cell error_of(const AgainstRow& row) {
    const auto iri = headline_of(row);
    return iri && row.survey_mm_per_m ? Cell{*iri - *row.survey_mm_per_m} : Cell{};
}

// clang-format off
const Columns<AgainstRow> columns{
    {"survey_line", as::integer, [](auto& r) { return r.survey.line; }},
    {"pass", as::integer, [](auto& r) { return r.pass.pass; }},
    {"lat_deg", as::degrees, [](auto& r) { return r.survey.at.lat_deg; }},
    {"lon_deg", as::degrees, [](auto& r) { return r.survey.at.lon_deg; }},
    {"from_m", as::metres(2), [](auto& r) { return r.pass.from_m; }},
    {"to_m", as::metres(2), [](auto& r) { return r.pass.to_m; }},
    {"t_s", as::seconds(3), [](auto& r) { return r.t_s; }},
    {"speed_mps", as::real(3, "m/s"),
     [](auto& r) { return known_if(headline_of(r).has_value(), r.mean.speed_mps); }},
    {"distance_m", as::metres(2), [](auto& r) { return r.pass.distance_m; }},
    {"survey", as::iri(3), [](auto& r) { return r.survey_mm_per_m; }},
    {"survey_index", as::text,
     [](auto& r) { return known_if(r.survey_mm_per_m.has_value(), r.survey_index); }},
    {"iri", as::iri(3), headline_of},
    {"index", as::text, [](auto& r) {
         return known_if(headline_of(r).has_value(), r.mean.mri_mm_per_m ? "MRI" : "HRI"); }},
    {"error", as::iri(3), error_of},
    {"iri_sd", as::iri(3),
     [](auto& r) { return known_if(headline_of(r).has_value(), r.mean.sd_mm_per_m); }},
    {"iri_low", as::iri(3),
     [](auto& r) { return known_if(headline_of(r).has_value(), interval_of(r).first); }},
    {"iri_high", as::iri(3),
     [](auto& r) { return known_if(headline_of(r).has_value(), interval_of(r).second); }},
    {"survey_left", as::iri(3), [](auto& r) { return r.survey.left_mm_per_m; }},
    {"iri_left", as::iri(3), [](auto& r) { return r.mean.left_mm_per_m; }},
    {"survey_right", as::iri(3), [](auto& r) { return r.survey.right_mm_per_m; }},
    {"iri_right", as::iri(3), [](auto& r) { return r.mean.right_mm_per_m; }},
    {"validity", as::text, [](auto& r) { return name_of_validity(r.mean.validity); }},
};

struct BandScore {
    std::string name;
    SurveyScore score;
};

const Columns<BandScore> score_columns{
    {"", as::text, [](auto& r) { return r.name; }, {"IRI, mm/m", "{:<14}"}},
    {"pieces", as::integer, [](auto& r) { return r.score.pieces; }, {"pieces", "{:>8}"}},
    {"mean_survey", as::iri(4), [](auto& r) { return r.score.mean_survey; }, {"survey", "{:>8}", 2}},
    {"mean_trip", as::iri(4), [](auto& r) { return r.score.mean_trip; }, {"trip", "{:>8}", 2}},
    {"bias", as::iri(4), [](auto& r) { return r.score.bias; }, {"bias", "{:>8}", 2}},
    {"sd", as::iri(4), [](auto& r) { return r.score.sd; }, {"sd", "{:>8}", 2}},
    {"rmse", as::iri(4), [](auto& r) { return r.score.rmse; }, {"RMSE", "{:>8}", 2}},
    {"correlation", as::real(4), [](auto& r) { return r.score.correlation; }, {"corr.", "{:>8}", 2}},
    {"coverage_90", as::real(4), [](auto& r) { return r.score.coverage; }},
    {"", as::real(0, "%"), [](auto& r) { return 100 * r.score.coverage; }, {"in 90 %", "{:>9}"}},
};
// clang-format on

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
    return against.rows.empty() ? "" : rows_text(columns, against.rows, "csv");
}

std::string against_json(const Against& against) {
    const auto pairs = compared_pairs(against);
    std::vector<std::string> bands;
    for (const auto& score : scores_by_band(pairs)) {
        JsonObject band;
        band.add("from", JsonNumber{score.from_mm_per_m, 0})
            .add("to", json_number(score.to_mm_per_m, 0))
            .add("score", JsonRaw{json_object(score_columns, {"", score}).text()});
        bands.push_back(band.text());
    }
    JsonObject object;
    object.add("survey_rows", static_cast<std::int64_t>(against.survey_rows))
        .add("met", static_cast<std::int64_t>(against.met))
        .add("score", JsonRaw{json_object(score_columns, {"", score_of(pairs)}).text()})
        .add("bands", JsonRaw{json_array(bands)})
        .add("rows", JsonRaw{json_rows(columns, against.rows)});
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
    std::vector<BandScore> scores{{"all", score_of(pairs)}};
    for (const auto& score : scores_by_band(pairs)) {
        scores.push_back({band_name(score), score});
    }
    return text + table_text(score_columns, scores);
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
