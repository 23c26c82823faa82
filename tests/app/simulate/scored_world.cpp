#include "app/simulate/scored_world.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdio>

namespace macadam::testing {
namespace {

using Json = nlohmann::json;

Score parsed_score(const Json& score) {
    const double mean = score["mean_truth"];
    return {.bias = score["bias_share"],
            .rmse_100m = score["rmse_100m"].get<double>() / mean,
            .coverage = score["coverage_90"],
            .segments = score["segments"]};
}

void print(const std::string& name, const Score& score) {
    std::printf("%-32s %5d segments: bias %+5.1f %%, RMSE of 100 m %4.1f %%, in 90 %%: %3.0f %%\n",
                name.c_str(),
                score.segments,
                100 * score.bias,
                100 * score.rmse_100m,
                100 * score.coverage);
}

} // namespace

Run ran(const std::vector<std::string>& words) {
    auto run = run_macadam(words);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run;
}

Scores score_of(const std::string& store, const std::string& truth) {
    const auto comparison =
        Json::parse(ran({"info", store, "--json", "--truth", truth}).out)["truth"];
    Scores scores{parsed_score(comparison["all"]), {}};
    for (const auto& band : comparison["by_level"]) {
        const auto to = band["to"].is_null() ? "" : fmt::format("{}", band["to"].get<double>());
        scores.by_level[fmt::format("{}-{}", band["from"].get<double>(), to)] =
            parsed_score(band["score"]);
    }
    return scores;
}

void print(const char* name, const Scores& scores) {
    print(name, scores.all);
    for (const auto& [band, score] : scores.by_level) {
        print(std::string{"  "} + band + " mm/m", score);
    }
}

} // namespace macadam::testing
