#include "app/store/truth_output.hpp"

#include "estimator/common/error.hpp"
#include "storage/surveys/truth_file.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace macadam {
namespace {

std::string cell(double value, int decimals) {
    return std::isnan(value) ? std::string{"-"} : fmt::format("{:.{}f}", value, decimals);
}

std::string row(std::string_view name, const TruthScore& score) {
    return fmt::format("{:<16}{:>9}{:>8.2f}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}\n",
                       name.empty() ? "(no class)" : name,
                       score.segments,
                       score.km,
                       cell(score.mean_truth, 2),
                       cell(score.bias, 2),
                       cell(100 * score.bias / score.mean_truth, 1),
                       cell(score.rmse, 2),
                       cell(score.rmse_100m, 2),
                       cell(score.correlation, 2),
                       cell(100 * score.coverage, 0));
}

JsonObject json_object(const TruthScore& score) {
    const auto number = [](double value, int decimals) {
        return json_number(std::isnan(value) ? std::optional<double>{} : value, decimals);
    };
    JsonObject object;
    object.add("segments", static_cast<std::int64_t>(score.segments))
        .add("km", number(score.km, 3))
        .add("mean_truth", number(score.mean_truth, 4))
        .add("bias", number(score.bias, 4))
        .add("bias_share", number(score.bias / score.mean_truth, 4))
        .add("rmse_20m", number(score.rmse, 4))
        .add("runs_100m", static_cast<std::int64_t>(score.runs))
        .add("rmse_100m", number(score.rmse_100m, 4))
        .add("correlation", number(score.correlation, 4))
        .add("coverage_90", number(score.coverage, 4));
    return object;
}

} // namespace

TruthComparison compared(const RoadStore& store, const std::filesystem::path& file) {
    const auto truth = read_truth(file);
    std::vector<SegmentRecord> states;
    store.visit({}, [&](const SegmentRecord& record) { states.push_back(record); });
    auto comparison = compare_with_truth(states, truth);
    if (comparison.all.segments == 0) {
        throw InputError{fmt::format("{}: contains none of the {} measured segments, expected "
                                     "true values of this network",
                                     file.string(),
                                     states.size())};
    }
    return comparison;
}

std::string text_of(const TruthComparison& comparison) {
    auto text = fmt::format("{:<16}{:>9}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}\n",
                            "against truth",
                            "segments",
                            "km",
                            "truth",
                            "bias",
                            "bias %",
                            "RMSE",
                            "at 100",
                            "corr.",
                            "in 90 %");
    text += row("all", comparison.all);
    for (const auto& [highway, score] : comparison.classes) {
        text += row(highway, score);
    }
    return text + "IRI (MRI) in mm/m; RMSE of single segments, and of five in a row (about 100 "
                  "m); share of true\n"
                  "values within the 90 % interval, %\n";
}

std::string json_of(const TruthComparison& comparison) {
    std::vector<std::string> classes;
    for (const auto& [highway, score] : comparison.classes) {
        JsonObject entry;
        entry.add("highway", highway).add("score", JsonRaw{json_object(score).text()});
        classes.push_back(entry.text());
    }
    JsonObject object;
    object.add("all", JsonRaw{json_object(comparison.all).text()})
        .add("classes", JsonRaw{json_array(classes)});
    return object.text();
}

} // namespace macadam
