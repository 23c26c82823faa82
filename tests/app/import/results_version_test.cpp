// Results of one log, held beside the number of their version: workers that compute others must not
// write to one database.

#include "app/pipeline/results_version.hpp"
#include "support/program/places.hpp"
#include "support/program/program.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace macadam::testing {
namespace {

/// Digest of a new database with the sample log, on any processor:
///
///     macadam init roads.gpkg --trace sample_data/gyor/gyor_q3_00.trip.csv
///     macadam import roads.gpkg sample_data/gyor/gyor_q3_00.trip.csv
///     macadam info roads.gpkg --digest
constexpr const char* expected_digest =
    "99a23bbbeba6948a8c786473d4c6b5b83b866dccfa9cbfd3ef7a58ebb8826a88";
constexpr int expected_version = 2;

std::string output(const std::vector<std::string>& words) {
    const auto run = run_macadam(words);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run.out;
}

TEST(ResultsVersion, GrowsWithEveryChangeOfResults) {
    const auto store = (fresh_folder() / "roads.gpkg").string();
    const auto log = source_folder() + "/sample_data/gyor/gyor_q3_00.trip.csv";
    output({"init", store, "--trace", log});
    output({"import", store, log, "--quiet"});
    auto digest = output({"info", store, "--digest"});
    digest.resize(digest.find_last_not_of('\n') + 1);
    EXPECT_EQ(digest, expected_digest)
        << "this log gives other results than before: count results_version up "
           "(app/pipeline/results_version.hpp), and write its new number and this digest here";
    EXPECT_EQ(results_version, expected_version)
        << "the version of results has changed: write it here, with the digest of its results";
}

} // namespace
} // namespace macadam::testing
