// `macadam init STORE --update` as users run it, on a small made-up country.

#include "storage/networks/osm_writer.hpp"
#include "storage/store/road_store.hpp"
#include "support/program/program.hpp"
#include "support/roads/edited_network.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

/// The country with its long road renumbered and the nameless one gone.
std::string newer_map(const std::filesystem::path& folder) {
    auto network = edited(copies_of_ways(small_country()));
    for (auto& [way, steps] : network.ways) {
        way.highway = "residential"; // what a car may use
        way.turns.clear();
    }
    renumber(network, 1, 100);
    erase(network, 3);
    const auto file = folder / "newer.osm.pbf";
    write_osm(ways_of(network), file);
    return file.string();
}

TEST(UpdateProgram, CarriesPassesAndReports) {
    const auto folder = fresh_folder();
    const auto file = (folder / "roads.gpkg").string();
    {
        auto store = new_store(file);
        import_trips(store, 3);
    }
    const auto run = run_macadam({"init", file, "--update", newer_map(folder), "--json"});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    const auto report = Json::parse(run.out);
    EXPECT_EQ(report["passes_lost"], 0);
    EXPECT_EQ(report["passes_carried"], 60); // three trips along ten segments and back
    EXPECT_EQ(report["passes_now"], 60);
    EXPECT_EQ(report["generation"], 2);
    EXPECT_GT(report["lost"]["segments"], 0);
    EXPECT_EQ(report["lost_roads"][0]["name"], "way 3");
    EXPECT_TRUE(std::filesystem::exists(file + "-network"));

    const auto query = run_macadam({"query", file, "--segment", "100+0003", "--json"});
    EXPECT_EQ(query.exit_status, 0) << query.err;
    EXPECT_THAT(query.out, HasSubstr("100+0003"));
    const auto again = run_macadam({"init", file, "--update", newer_map(folder)});
    EXPECT_EQ(again.exit_status, 0) << again.err;
    EXPECT_THAT(again.out, HasSubstr("unchanged"));
    EXPECT_THAT(again.out, HasSubstr("passes lost                          0"));
}

TEST(UpdateProgram, RefusesWhatItCannotDo) {
    const auto folder = fresh_folder();
    const auto map = newer_map(folder);
    const auto file = (folder / "roads.gpkg").string();
    const auto missing = run_macadam({"init", file, "--update", map});
    EXPECT_EQ(missing.exit_status, 1);
    EXPECT_THAT(missing.err,
                HasSubstr("no such file, expected a database made by 'macadam "
                          "init'"));
    const auto length = run_macadam({"init", file, "--update", map, "--segment-length", "10"});
    EXPECT_EQ(length.exit_status, 2);
    EXPECT_THAT(length.err, HasSubstr("--segment-length cannot be changed by --update"));
    const auto both = run_macadam({"init", file, "--update", map, "--network", map});
    EXPECT_EQ(both.exit_status, 2);
    EXPECT_THAT(both.err,
                HasSubstr("expected either --network FILE, --trace TRIP... or --update FILE"));
    const auto json = run_macadam({"init", file, "--network", map, "--json"});
    EXPECT_EQ(json.exit_status, 2);
    EXPECT_THAT(json.err, HasSubstr("--json requires --update"));
}

} // namespace
} // namespace macadam::testing
