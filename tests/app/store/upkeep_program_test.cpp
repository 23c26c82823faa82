// `macadam calibrate`, `reprocess`, `valid-from` and `forget` as users run them.

#include "storage/networks/network_file.hpp"
#include "storage/store/road_store.hpp"
#include "support/program/places.hpp"
#include "support/program/program.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;
using Json = nlohmann::json;

class UpkeepProgram : public ::testing::Test {
protected:
    void SetUp() override {
        store_ = (fresh_folder() / "roads.gpkg").string();
        auto store = new_store(store_);
        import_trips(store, 12);
        cache_network(store, small_country());
    }

    macadam::testing::Run run(const std::string& command, std::vector<std::string> words) const {
        words.insert(words.begin(), {command, store_});
        return run_macadam(words);
    }

    std::string beside(const std::string& name) const {
        return (std::filesystem::path{store_}.parent_path() / name).string();
    }

    std::string digest() const { return run("info", {"--digest"}).out; }

    std::string store_;
};

TEST_F(UpkeepProgram, ForgetsATripAndSaysWhatItTookOut) {
    const auto done = run("forget", {"--trip", "trip-2", "trip-5", "--json"});
    EXPECT_EQ(done.exit_status, 0) << done.err;
    const auto json = Json::parse(done.out);
    EXPECT_EQ(json["trips"], 2);
    EXPECT_EQ(json["passes"], 40);
    EXPECT_EQ(json["segments"], 20);
    EXPECT_EQ(json["calibrated_anew"], false);
    EXPECT_EQ(json["log_is_clean"], true);
    EXPECT_EQ(run("forget", {"--vehicle-id", "car-1"}).out,
              "4 trips permanently deleted: 80 passes over 20 segments\n");
}

TEST_F(UpkeepProgram, RefusesToForgetNobodyOrWhomItDoesNotKnow) {
    const auto nobody = run("forget", {});
    EXPECT_EQ(nobody.exit_status, 2);
    EXPECT_THAT(nobody.err, HasSubstr("expected --trip or --vehicle-id: what to delete"));
    const auto stranger = run("forget", {"--trip", "trip-99"});
    EXPECT_EQ(stranger.exit_status, 1);
    EXPECT_THAT(stranger.err, HasSubstr("roads.gpkg: has no trip 'trip-99', expected a trip_id"));
}

TEST_F(UpkeepProgram, SetsListsAndTakesBackADayFromWhichOnPassesCount) {
    const auto before = digest();
    const auto set = run("valid-from", {"--since", "2026-05-01", "--way", "1", "--reason", "new"});
    EXPECT_EQ(set.exit_status, 0) << set.err;
    EXPECT_THAT(set.err, HasSubstr("20 segments: only passes from 2026-05-01T00:00:00Z on count"));
    EXPECT_NE(digest(), before);
    EXPECT_THAT(run("valid-from", {}).out, HasSubstr("\n1+0000                   2026-05-01T00:"));
    const auto list = Json::parse(run("valid-from", {"--json"}).out);
    ASSERT_THAT(list, SizeIs(20));
    EXPECT_EQ(list[0]["segment"], "1+0000");
    EXPECT_EQ(list[0]["valid_from"], "2026-05-01T00:00:00Z");

    const auto listed = run("valid-from", {"--any-day", "--way", "1", "-o", "list.csv"});
    EXPECT_EQ(listed.exit_status, 2);
    EXPECT_THAT(listed.err, HasSubstr("--output belongs to the list of start dates"));
    EXPECT_EQ(run("valid-from", {"--any-day", "--way", "1"}).exit_status, 0);
    EXPECT_EQ(digest(), before);
    EXPECT_EQ(run("valid-from", {}).out, "no segment has a start date: all passes count\n");
}

TEST_F(UpkeepProgram, RefusesADayThatIsNoneAndARoadThatIsNone) {
    const auto words_of = [&](std::vector<std::string> words, int status) {
        const auto done = run("valid-from", std::move(words));
        EXPECT_EQ(done.exit_status, status);
        return done.err;
    };
    EXPECT_THAT(words_of({"--since", "tomorrow", "--way", "1"}, 2),
                HasSubstr("--since is 'tomorrow', expected a time such as 2026-03"));
    EXPECT_THAT(words_of({"--since", "2026-05-01"}, 2),
                HasSubstr("expected a selection of roads: --segment, --way, --road, --highway "
                          "or --bbox"));
    EXPECT_THAT(words_of({"--since", "2026-05-01", "--any-day", "--way", "1"}, 2),
                HasSubstr("--since and --any-day cannot be combined"));
    EXPECT_THAT(words_of({"--since", "2026-05-01", "--way", "77"}, 1),
                HasSubstr("roads.gpkg: has no segment that meets these conditions"));
}

TEST_F(UpkeepProgram, CalibratesTheCarsAndTellsThem) {
    const auto before = digest();
    const auto asked = run("calibrate", {"--dry-run", "--json"});
    EXPECT_EQ(asked.exit_status, 0) << asked.err;
    EXPECT_EQ(Json::parse(asked.out)["generation"], 1);
    EXPECT_EQ(digest(), before);
    EXPECT_THAT(run("calibrate", {"--dry-run"}).out,
                HasSubstr("cars left out       90 % intervals from the other cars held "));

    const auto done = run("calibrate", {"--json"});
    const auto json = Json::parse(done.out);
    EXPECT_EQ(json["generation"], 2);
    EXPECT_GT(json["left_out_passes"], 0);
    EXPECT_GE(json["left_out_coverage"], 0.0);
    EXPECT_LE(json["left_out_coverage"], 1.0);
    ASSERT_THAT(json["cars"], SizeIs(3));
    EXPECT_EQ(json["cars"][0]["trips"], 4);
    EXPECT_GT(json["cars"][0]["gain"], 0.5);
    EXPECT_NE(digest(), before);

    const auto info = Json::parse(run("info", {"--json"}).out);
    EXPECT_EQ(info["generation"], 2);
    EXPECT_TRUE(info["cars"][0]["gain"].is_number());
    EXPECT_THAT(run("info", {}).out, HasSubstr(" IRI "));
}

TEST_F(UpkeepProgram, WritesTheRowsOfACalibrationInEachFormat) {
    const auto csv = run("calibrate", {"--dry-run", "--format", "csv"});
    EXPECT_EQ(csv.exit_status, 0) << csv.err;
    EXPECT_THAT(
        csv.out,
        StartsWith("vehicle,trips,shared_passes,gain,offset_mm_per_m,relative_sd,scatter\n"));
    EXPECT_EQ(std::ranges::count(csv.out, '\n'), 4);
    const auto file = beside("cars.csv");
    EXPECT_EQ(run("calibrate", {"--dry-run", "-o", file}).out, "");
    EXPECT_EQ(read_file(file), csv.out);
    const auto refused = run("calibrate", {"--dry-run", "-o", "cars.xls"});
    EXPECT_EQ(refused.exit_status, 2);
    EXPECT_THAT(
        refused.err,
        HasSubstr("-o is 'cars.xls', expected a name that ends in .csv, .json, or --format"));
}

TEST_F(UpkeepProgram, PrintsOneTableOfADatabaseWithAllItsRows) {
    const auto json = Json::parse(run("info", {"--json"}).out);
    const std::vector<std::pair<std::string, std::string>> tables{
        {"classes", "classes"},
        {"road-classes", "road_classes"},
        {"cars", "cars"},
        {"months", "passes_per_month"},
        {"days", "passes_per_day"},
        {"surveys", "surveys"},
        {"control-sections", "control_sections"}};
    for (const auto& [name, member] : tables) {
        const auto csv = run("info", {"--table", name, "--format", "csv"}).out;
        EXPECT_EQ(std::ranges::count(csv, '\n'), std::ssize(json[member]) + 1) << name;
    }
    EXPECT_EQ(Json::parse(run("info", {"--table", "cars", "--json"}).out), json["cars"]);
    EXPECT_THAT(run("info", {"--table", "months"}).out, StartsWith("month "));
    EXPECT_THAT(run("info", {"--audit", "--format", "csv"}).out,
                StartsWith("at,generation,what,detail,segments\n"));
    const auto whole = beside("info.json");
    EXPECT_EQ(run("info", {"-o", whole}).out, "");
    EXPECT_EQ(Json::parse(read_file(whole)), json);
}

TEST_F(UpkeepProgram, RefusesCsvOfMoreThanOneTable) {
    const auto refusal = [&](std::vector<std::string> words) {
        const auto done = run("info", std::move(words));
        EXPECT_EQ(done.exit_status, 2);
        return done.err;
    };
    const auto* const one = "CSV holds one table, expected --table NAME, --audit or --truth FILE";
    EXPECT_THAT(refusal({"--format", "csv"}), HasSubstr(one));
    EXPECT_THAT(refusal({"-o", "info.csv"}), HasSubstr(one));
    EXPECT_THAT(refusal({"--digest", "--format", "csv"}), HasSubstr(one));
    EXPECT_THAT(refusal({"--audit", "--table", "cars"}),
                HasSubstr("--audit and --table cannot be combined"));
}

TEST_F(UpkeepProgram, LeavesAStoreAsItWasWhereNoCarCanBeCalibrated) {
    run("forget", {"--vehicle-id", "car-1", "car-2"});
    const auto before = digest();
    const auto done = run("calibrate", {});
    EXPECT_EQ(done.exit_status, 1);
    EXPECT_THAT(done.err, HasSubstr("no car could be calibrated: each needs 50 segments"));
    EXPECT_THAT(done.err, HasSubstr("the database is unchanged"));
    EXPECT_THAT(done.out, ::testing::Not(HasSubstr("between cars")));
    EXPECT_EQ(digest(), before);
    EXPECT_EQ(Json::parse(run("info", {"--json"}).out)["generation"], 1);
}

TEST_F(UpkeepProgram, TellsWhatWasDoneAndWhatItDidToANumber) {
    run("valid-from", {"--since", "2026-05", "--segment", "1+0003", "--reason", "resurfaced"});
    EXPECT_THAT(run("info", {"--audit"}).out,
                HasSubstr("1  valid-from: 1 segments from 2026-05-01T00:00:00.000Z: resurfaced"));
    const auto audit = Json::parse(run("info", {"--audit", "--json"}).out);
    ASSERT_THAT(audit, SizeIs(2));
    EXPECT_EQ(audit[0]["what"], "import");
    EXPECT_EQ(audit[0]["segments"], 20);

    const auto changes = run("query", {"--segment", "1+0003", "--changes", "--json"});
    const auto json = Json::parse(changes.out);
    ASSERT_THAT(json, SizeIs(2));
    EXPECT_EQ(json[0]["passes"], 12);
    EXPECT_LT(json[1]["passes"], 12);
    EXPECT_EQ(json[1]["detail"], "1 segments from 2026-05-01T00:00:00.000Z: resurfaced");
    EXPECT_THAT(run("query", {"--segment", "1+0003", "--changes", "--format", "csv"}).out,
                StartsWith("at,generation,iri,iri_sd,passes,what,detail\n20"));
    const auto misuse = run("query", {"--way", "1", "--changes"});
    EXPECT_EQ(misuse.exit_status, 2);
    EXPECT_THAT(misuse.err, HasSubstr("--changes requires --segment KEY"));
}

TEST_F(UpkeepProgram, ReprocessesNothingOfTripsThatAreNotThere) {
    const auto before = digest();
    const auto log = source_folder() + "/sample_data/gyor/gyor_q3_00.trip.csv";
    const auto done = run("reprocess", {log});
    EXPECT_EQ(done.exit_status, 1);
    EXPECT_THAT(done.out, HasSubstr("is not in the database: import it with 'macadam import'"));
    EXPECT_THAT(done.err,
                HasSubstr("no trip of 1 trip was reprocessed: the database is unchanged"));
    EXPECT_EQ(digest(), before);
}

TEST(Maintenance, OfARecordedTripForgetsTakesBackAndReprocesses) {
    const auto folder = fresh_folder();
    const auto log = source_folder() + "/sample_data/gyor/gyor_q3_00.trip.csv";
    const auto store_by = [&](const std::string& name, const std::string& method) {
        const auto store = (folder / name).string();
        EXPECT_EQ(run_macadam({"init", store, "--trace", log}).exit_status, 0);
        EXPECT_EQ(run_macadam({"import", store, log, "--method", method}).exit_status, 0);
        return store;
    };
    const auto digest_of = [](const std::string& store) {
        return run_macadam({"info", store, "--digest"}).out;
    };
    const auto store = store_by("a.gpkg", "kf");
    const auto by_kf = digest_of(store);
    EXPECT_EQ(run_macadam({"forget", store, "--trip", "gyor_q3_00.trip.csv"}).exit_status, 0);
    EXPECT_NE(digest_of(store), by_kf);
    const auto known = run_macadam({"import", store, log, "--method", "kf"});
    EXPECT_EQ(known.exit_status, 0);
    EXPECT_THAT(known.out, HasSubstr("was permanently deleted on request"));
    const auto back = run_macadam({"import", store, log, "--method", "kf", "--take-back"});
    EXPECT_THAT(back.out, StartsWith("imported"));
    EXPECT_EQ(digest_of(store), by_kf);

    const auto anew = run_macadam({"reprocess", store, log, "--method", "smoother"});
    EXPECT_EQ(anew.exit_status, 0) << anew.err;
    EXPECT_THAT(anew.out, StartsWith("reprocessed"));
    EXPECT_THAT(anew.err, HasSubstr("generation 2: 1 trip reprocessed, 0 unchanged"));
    EXPECT_EQ(digest_of(store), digest_of(store_by("b.gpkg", "smoother")));
}

} // namespace
} // namespace macadam::testing
