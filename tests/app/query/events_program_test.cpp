// Potholes and other events, as users see them: query, export, render, report.

#include "storage/store/road_store.hpp"
#include "support/files/files.hpp"
#include "support/program/program.hpp"
#include "support/roads/store_world.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

class EventsProgram : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fresh_folder();
        auto store = new_store(folder_ / "roads.gpkg");
        for (const int number : {0, 1, 2}) {
            add_trip(store, trip_record(number), passes_of(number), {}, std::vector{pothole_});
        }
        store.importer.refresh();
    }

    std::string at(const char* name) const { return (folder_ / name).string(); }

    macadam::testing::Run run(const char* command, std::vector<std::string> words) const {
        words.insert(words.begin(), {command, at("roads.gpkg")});
        return run_macadam(words);
    }

    std::filesystem::path folder_;
    PassEvent pothole_{.segment = {1, true, 2},
                       .occurrence = 0,
                       .kind = EventKind::pothole,
                       .track = WheelTrack::unknown,
                       .at_mm = 45'000,
                       .place_sd_mm = 1'000,
                       .size_um = 31'000,
                       .sd_um = 9'500,
                       .length_mm = 750};
};

TEST_F(EventsProgram, ListsThemWithThePlaceWhereTheyAreLookedUp) {
    const auto table = run("query", {"--events"});
    ASSERT_EQ(table.exit_status, 0) << table.err;
    EXPECT_THAT(table.out, HasSubstr("pothole  moderate unknown   31"));
    EXPECT_THAT(table.out, HasSubstr("Rue de l'Épée 100%"));
    EXPECT_THAT(table.out, HasSubstr("3 of 3"));

    const auto json = Json::parse(run("query", {"--way", "1", "--events", "--json"}).out);
    ASSERT_EQ(json.size(), 1U);
    EXPECT_EQ(json[0]["segment"], "1+0002");
    EXPECT_EQ(json[0]["at_m"], 45);
    EXPECT_EQ(json[0]["passes"], 3);

    const auto csv = run("query", {"--events", "--format", "csv"});
    EXPECT_THAT(csv.out,
                HasSubstr("kind,severity,track,size_mm,size_sd_mm,length_m,lat_deg,lon_deg,"
                          "place_sd_m,name,highway,segment,way_id,direction,at_m,passes,"
                          "passes_over,vehicles,first_seen,last_seen\npothole,"));
    const auto geojson = Json::parse(run("query", {"--events", "--format", "geojson"}).out);
    EXPECT_EQ(geojson["features"][0]["geometry"]["type"], "Point");
}

TEST_F(EventsProgram, FindsThemNearAPoint) {
    const auto all = Json::parse(run("query", {"--events", "--json"}).out);
    ASSERT_EQ(all.size(), 1U);
    const auto place = all[0]["lat_deg"].dump() + "," + all[0]["lon_deg"].dump();
    EXPECT_EQ(Json::parse(run("query", {"--events", "--near", place, "--json"}).out), all);
    const auto far = run("query", {"--events", "--way", "2", "--json"});
    EXPECT_EQ(far.exit_status, 0);
    EXPECT_EQ(Json::parse(far.out), Json::array());
    EXPECT_THAT(far.err, HasSubstr("no pothole, bump, joint or rail was reported by two passes"));
}

TEST_F(EventsProgram, RefusesWhatEventsDoNotHave) {
    for (const auto& words : {std::vector<std::string>{"--events", "--worst", "3"},
                              {"--events", "--history", "--way", "1"},
                              {"--events", "--all"},
                              {"--events", "--segment", "1+0002", "--passes"}}) {
        const auto refused = run("query", words);
        EXPECT_EQ(refused.exit_status, 2) << words[1];
        EXPECT_THAT(refused.err, HasSubstr("--events cannot be combined with")) << words[1];
    }
    for (const auto* const name : {"a.shp", "a.fgb", "a.pmtiles", "tiles/"}) {
        const auto refused = run("export", {"-o", at(name), "--events"});
        EXPECT_EQ(refused.exit_status, 2) << name;
        EXPECT_THAT(refused.err, HasSubstr("expected a name that ends in .geojson")) << name;
    }
}

TEST_F(EventsProgram, ExportsThemAsPoints) {
    for (const auto* const name : {"e.geojson", "e.geojsonl", "e.csv", "e.gpkg", "e.kml"}) {
        const auto done = run("export", {"-o", at(name), "--events"});
        ASSERT_EQ(done.exit_status, 0) << done.err;
        EXPECT_THAT(done.err, HasSubstr("1 event"));
    }
    EXPECT_EQ(Json::parse(read_file(at("e.geojson")))["features"].size(), 1U);
}

TEST_F(EventsProgram, DrawsThemOnlyWhenAsked) {
    const auto picture = [&](const char* name, std::vector<std::string> words) {
        words.insert(words.begin(), {"-o", at(name), "--size", "512x512"});
        const auto done = run("render", words);
        EXPECT_EQ(done.exit_status, 0) << done.err;
        return read_file(at(name));
    };
    const auto plain = picture("plain.png", {});
    EXPECT_NE(picture("events.png", {"--events"}), plain);
    EXPECT_EQ(picture("again.png", {}), plain);
}

/// The pothole lies at 45 m of the street, the box around its last 20 of 200 m.
TEST_F(EventsProgram, NamesNoKindInTheLegendThatIsNotOnTheMap) {
    const auto street =
        Json::parse(run("query", {"--segment", "1+0009", "--format", "geojson"}).out);
    ASSERT_EQ(street["features"].size(), 1U);
    const auto line = street["features"][0]["geometry"]["coordinates"];
    const auto picture = [&](const char* name, std::vector<std::string> words) {
        constexpr double margin_deg = 2e-5; // 2 m
        const double lat_deg = line[0][1];
        words.insert(words.begin(),
                     {"-o",
                      at(name),
                      "--size",
                      "512x512",
                      fmt::format("--bbox={},{},{},{}",
                                  line.front()[0].get<double>(),
                                  lat_deg - margin_deg,
                                  line.back()[0].get<double>(),
                                  lat_deg + margin_deg)});
        const auto done = run("render", words);
        EXPECT_EQ(done.exit_status, 0) << done.err;
        return read_file(at(name));
    };
    EXPECT_EQ(picture("events.png", {"--events"}), picture("plain.png", {}));
}

TEST_F(EventsProgram, AreListedInReports) {
    const auto report = [&](const char* name, std::vector<std::string> words) {
        words.insert(words.begin(), {"-o", at(name)});
        const auto done = run("report", words);
        EXPECT_EQ(done.exit_status, 0) << done.err;
        return read_file(at(name));
    };
    const auto english = report("en.html", {});
    EXPECT_THAT(english, HasSubstr("Potholes and other events"));
    EXPECT_THAT(english, HasSubstr("3 of 3"));
    EXPECT_THAT(report("de.html", {"--language", "de"}), HasSubstr("Schlaglöcher und andere"));

    run("forget", {"--trip", "trip-1", "--trip", "trip-2"});
    EXPECT_THAT(report("none.html", {}), Not(HasSubstr("Potholes")));
}

} // namespace
} // namespace macadam::testing
