// `compare`, by the program itself: a simulated fleet whose truth is known, surveys, and profiles.

#include "support/program/program.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <string>
#include <unistd.h>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

const std::string town = R"(<osm version="0.6">
<node id="1" lat="48.4000000" lon="15.6000000"/>
<node id="2" lat="48.4000000" lon="15.6054000"/>
<node id="4" lat="48.4036000" lon="15.6000000"/>
<node id="5" lat="48.4036000" lon="15.6054000"/>
<way id="11"><nd ref="1"/><nd ref="2"/><tag k="highway" v="primary"/></way>
<way id="12"><nd ref="4"/><nd ref="5"/><tag k="highway" v="primary"/></way>
<way id="13"><nd ref="1"/><nd ref="4"/><tag k="highway" v="residential"/></way>
<way id="14"><nd ref="2"/><nd ref="5"/><tag k="highway" v="residential"/></way>
</osm>
)";

const std::string recipe = R"([trips]
count = 4
length_km = [1.4, 1.6]
stop_share = 0
[[car]]
id = "one"
[[car]]
id = "two"
)";

const std::string slow_recipe = R"([trips]
from = "2025-06-01"
to = "2025-06-20"
count = 2
length_km = [1.4, 1.6]
stop_share = 0
[speed_kmh]
primary = 36
residential = 25
[[car]]
id = "slow"
)";

testing::Run ran(const std::vector<std::string>& words, int exit_status = 0) {
    auto run = run_macadam(words);
    EXPECT_EQ(run.exit_status, exit_status) << run.err;
    return run;
}

json compared(std::vector<std::string> words) {
    words.insert(words.begin(), "compare");
    words.emplace_back("--json");
    return json::parse(ran(words).out);
}

/// Groups by that property; null if there are none.
json groups_by(const json& comparison, const std::string& property) {
    for (const auto& by : comparison["by"]) {
        if (by["property"] == property) {
            return by["groups"];
        }
    }
    return nullptr;
}

/// A profile of three waves, with stations, moved and raised.
std::string profile(double moved_m, double gain) {
    std::string text{"station_m,left_m\n"};
    for (int i = 0; i < 4000; ++i) {
        const double at_m = 0.05 * i;
        double z = 0;
        for (const double wavelength_m : {0.9, 3.1, 4.7, 11.3, 23.0}) {
            z += gain * 3e-4 * wavelength_m *
                 std::sin(2 * std::numbers::pi * (at_m - moved_m) / wavelength_m);
        }
        text += fmt::format("{:.3f},{:.7f}\n", at_m, z);
    }
    return text;
}

/// A database with the trips of a fleet, made once.
class Compare : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        // Tests may run at once, each as a process of its own.
        fleet_ = fs::path{::testing::TempDir()} / fmt::format("macadam_compare_{}", ::getpid());
        fs::remove_all(fleet_);
        fs::create_directories(fleet_);
        write_file(fleet_ / "town.osm", town);
        write_file(fleet_ / "recipe.toml", recipe);
        const auto made = (fleet_ / "fleet").string();
        ran({"simulate",
             "-o",
             made,
             "--network",
             (fleet_ / "town.osm").string(),
             "--recipe",
             (fleet_ / "recipe.toml").string()});
        ran({"init", made + "/roads.gpkg", "--network", made + "/network.osm.pbf"});
        ran({"import", made + "/roads.gpkg", made + "/trips", "--method", "kf"});
    }

    static void TearDownTestSuite() { fs::remove_all(fleet_); }

    void SetUp() override {
        folder_ = fresh_folder();
        store_ = (fleet_ / "fleet" / "roads.gpkg").string();
        truth_ = (fleet_ / "fleet" / "truth.csv").string();
    }

    std::string written(const std::string& name, const std::string& text) const {
        write_file(folder_ / name, text);
        return (folder_ / name).string();
    }

    static fs::path fleet_;
    fs::path folder_;
    std::string store_;
    std::string truth_;
};

fs::path Compare::fleet_;

TEST_F(Compare, NamesTwoFilesOfOneNameByTheirFolders) {
    fs::create_directories(folder_ / "2026");
    const auto before = written("road.csv", profile(0, 1));
    const auto after = written("2026/road.csv", profile(0, 1));
    const auto out = ran({"compare", before, after}).out;
    EXPECT_THAT(out, HasSubstr("A  " + before + " (profile)"));
    EXPECT_THAT(out, HasSubstr("B  " + after + " (profile)"));
}

TEST_F(Compare, OfADatabaseAndTheTruthGivesTheErrorsThatInfoGives) {
    const auto of_truth =
        json::parse(ran({"info", store_, "--json", "--truth", truth_}).out)["truth"]["all"];
    const auto comparison = compared({store_, truth_});
    const auto& all = comparison["all"];
    EXPECT_EQ(all["pairs"], of_truth["segments"]);
    // Both files have micrometres per metre.
    EXPECT_NEAR(all["difference"]["bias"]["value"], of_truth["bias"], 1e-3);
    EXPECT_LT(all["difference"]["independent"], all["pairs"].get<double>() + 1);
    EXPECT_LT(all["difference"]["bias"]["low_95"], all["difference"]["bias"]["value"]);
    EXPECT_EQ(groups_by(comparison, "Road class").size(), 2U);
    EXPECT_EQ(groups_by(comparison, "Car of A").size(), 2U);
    std::size_t by_speed = 0;
    for (const auto& group : groups_by(comparison, "Speed, km/h")) {
        by_speed += group["pairs"].get<std::size_t>();
    }
    EXPECT_EQ(by_speed, all["pairs"].get<std::size_t>());
    const auto turned = compared({truth_, store_})["all"];
    EXPECT_NEAR(turned["difference"]["bias"]["value"].get<double>(),
                -all["difference"]["bias"]["value"].get<double>(),
                1e-9);
}

TEST_F(Compare, WritesARowForEachGroupOfDatabasesAndEachBandOfProfiles) {
    const auto comparison = compared({store_, truth_});
    std::ptrdiff_t groups = 1; // all pairs
    for (const auto& by : comparison["by"]) {
        groups += std::ssize(by["groups"]);
    }
    const auto csv = ran({"compare", store_, truth_, "--format", "csv"}).out;
    EXPECT_THAT(csv, StartsWith("by,name,pairs,independent,mean_a,mean_b,bias,"));
    EXPECT_EQ(std::ranges::count(csv, '\n'), groups + 1);
    EXPECT_THAT(csv, HasSubstr(fmt::format("\n,all,{},", comparison["all"]["pairs"].dump())));
    const auto file = (folder_ / "rows.csv").string();
    EXPECT_EQ(ran({"compare", store_, truth_, "-o", file}).out, "");
    EXPECT_EQ(read_file(file), csv);
    const auto page = (folder_ / "page.html").string();
    EXPECT_EQ(ran({"compare", store_, truth_, "-o", page, "--format", "csv"}).out, csv);
    EXPECT_THAT(read_file(page), HasSubstr("<svg"));

    const auto a = written("a.csv", profile(0, 1));
    const auto b = written("b.csv", profile(0.3, 1.1));
    const auto bands = ran({"compare", a, b, "--format", "csv"}).out;
    EXPECT_THAT(bands, StartsWith("track,shared_m,iri_a,iri_b,band,from_m,to_m,score,"));
    EXPECT_EQ(std::ranges::count(bands, '\n'),
              std::ssize(compared({a, b})["tracks"][0]["bands"]) + 1);
}

TEST_F(Compare, LeavesSurveysInsideADatabaseOut) {
    const auto copy = (folder_ / "copy.gpkg").string();
    fs::copy(store_, copy);
    ran({"import", copy, "--reference", truth_, "--date", "2026-05-01"});
    EXPECT_EQ(compared({copy, truth_})["all"], compared({store_, truth_})["all"]);
}

TEST_F(Compare, OfADatabaseAndItsCopyFindsNoDifference) {
    const auto copy = (folder_ / "copy.gpkg").string();
    fs::copy(store_, copy);
    const auto comparison = compared({store_, copy});
    EXPECT_GT(comparison["all"]["pairs"], 50);
    EXPECT_EQ(comparison["all"]["difference"]["sd"], 0);
    EXPECT_EQ(comparison["shared"]["only_a"], 0);
    EXPECT_EQ(comparison["shared"]["cut_differently"], 0);
}

TEST_F(Compare, OfTwoCarsOfOneDatabaseTakesTheRoadsOfBoth) {
    const auto comparison = compared({store_, store_, "--car-a", "one", "--car-b", "two"});
    EXPECT_GT(comparison["all"]["pairs"], 20);
    EXPECT_THAT(comparison["a"]["car"].get<std::string>(), HasSubstr("car "));
    EXPECT_NE(comparison["a"]["car"], comparison["b"]["car"]);
    const auto turned = compared({store_, store_, "--car-a", "two", "--car-b", "one"});
    EXPECT_EQ(turned["all"]["mean_a"], comparison["all"]["mean_b"]);
    EXPECT_THAT(ran({"compare", store_, store_, "--car-a", "three"}, 1).err,
                HasSubstr("has no car 'three'"));
    EXPECT_THAT(ran({"compare", store_, store_}, 2).err,
                HasSubstr("--car-a and --car-b select two of its cars"));
}

/// Pairs by band of speed.
std::map<std::string, std::size_t> pairs_by_speed(const json& comparison) {
    std::map<std::string, std::size_t> pairs;
    for (const auto& group : groups_by(comparison, "Speed, km/h")) {
        pairs[group["name"]] = group["pairs"];
    }
    return pairs;
}

TEST_F(Compare, GroupsThePassesOfTheChosenCarAndTimeOnly) {
    // A third car is slower than the two others, and drives in June; they do in March and October.
    const auto simulated = fleet_ / "fleet";
    const auto slow = (folder_ / "slow").string();
    ran({"simulate",
         "-o",
         slow,
         "--network",
         (fleet_ / "town.osm").string(),
         "--recipe",
         written("slow.toml", slow_recipe),
         "--seed",
         "2"});
    const auto network = (simulated / "network.osm.pbf").string();
    const auto alone = (folder_ / "alone.gpkg").string(), all = (folder_ / "all.gpkg").string();
    ran({"init", alone, "--network", network});
    ran({"import", alone, slow + "/trips", "--method", "kf"});
    ran({"init", all, "--network", network});
    ran({"import", all, slow + "/trips", (simulated / "trips").string(), "--method", "kf"});

    const auto expected = pairs_by_speed(compared({alone, truth_}));
    EXPECT_NE(pairs_by_speed(compared({all, truth_})), expected);
    EXPECT_EQ(pairs_by_speed(compared({all, truth_, "--car-a", "slow"})), expected);
    EXPECT_EQ(pairs_by_speed(compared({truth_, all, "--car-b", "slow"})), expected);
    const auto june = compared({all, truth_, "--since", "2025-06", "--until", "2025-06"});
    EXPECT_EQ(pairs_by_speed(june), expected);
    const auto cars = groups_by(june, "Car of A");
    ASSERT_EQ(cars.size(), 1U);
    EXPECT_EQ(cars[0]["pairs"], june["all"]["pairs"]);
}

TEST_F(Compare, InUsUnitsIsTheSameTimes63) {
    const auto si = compared({store_, truth_});
    const auto us = compared({store_, truth_, "--units", "us"});
    EXPECT_EQ(us["unit"], "in/mi");
    EXPECT_EQ(us["all"]["pairs"], si["all"]["pairs"]);
    EXPECT_NEAR(us["all"]["mean_a"], 63.36 * double(si["all"]["mean_a"]), 0.01);
    EXPECT_NEAR(us["all"]["difference"]["sd"], 63.36 * double(si["all"]["difference"]["sd"]), 0.01);
    EXPECT_EQ(us["all"]["relative_percent"], si["all"]["relative_percent"]);
    const auto page = (folder_ / "us.html").string();
    const auto text = run_macadam({"compare", store_, truth_, "--units", "us", "-o", page}).out;
    for (const auto& shown : {text, read_file(page)}) {
        EXPECT_THAT(shown, HasSubstr("in/mi"));
        EXPECT_THAT(shown, Not(HasSubstr("mm/m")));
        EXPECT_THAT(shown, Not(HasSubstr(" km")));
    }
}

TEST_F(Compare, OfTwoSurveysFindsTheirRatioOnTheRoadsOfADatabase) {
    const std::string head{"way_id,direction,from_m,to_m,mri\n"};
    std::string first{head}, second{head};
    for (int i = 0; i < 10; ++i) {
        first += fmt::format("11,forward,{},{},{}\n", 20 * i, 20 * i + 20, 1 + 0.1 * i);
        second += fmt::format("11,forward,{},{},{}\n", 20 * i, 20 * i + 20, 1.1 * (1 + 0.1 * i));
    }
    const auto a = written("first.csv", first), b = written("second.csv", second);
    const auto comparison = compared({a, b, "--roads", store_});
    EXPECT_EQ(comparison["all"]["pairs"], 10);
    // 100 (1 - 1.1) / 1.05, to the micrometres of passes.
    EXPECT_NEAR(comparison["all"]["relative_percent"]["bias"]["value"], -9.524, 0.05);
    EXPECT_THAT(ran({"compare", a, b}, 2).err, HasSubstr("add --roads STORE.gpkg"));
}

TEST_F(Compare, OfTwoProfilesFindsLagGainAndScore) {
    const auto a = written("a.csv", profile(0, 1)), b = written("b.csv", profile(0.4, 0.8));
    const auto comparison = compared({a, b});
    ASSERT_EQ(comparison["tracks"].size(), 1U);
    const auto& track = comparison["tracks"][0];
    ASSERT_EQ(track["bands"].size(), 4U);
    EXPECT_NEAR(track["bands"][0]["lag_m"], 0.4, 0.02);
    EXPECT_NEAR(track["bands"][0]["gain"], 1.25, 0.01);
    EXPECT_NEAR(track["bands"][0]["score"], 0.8, 0.01);
    EXPECT_NEAR(track["iri_a"].get<double>() / track["iri_b"].get<double>(), 1.25, 0.01);
    EXPECT_EQ(track["meets_accuracy"], false);
    EXPECT_EQ(comparison["shared"], nullptr);
    EXPECT_THAT(ran({"compare", a, store_}, 1).err, HasSubstr("a profile has no place on a road"));
}

TEST_F(Compare, RefusesProfilesWithGapsOrTooFewPoints) {
    const auto whole = written("whole.csv", profile(0, 1));
    auto text = profile(0, 1);
    const auto from = text.find("50.000,"), to = text.find("50.700,");
    const auto gap = written("gap.csv", text.erase(from, to - from));
    EXPECT_THAT(ran({"compare", whole, gap}, 1).err,
                HasSubstr("gap.csv: has no point between stations 49.950 and 50.700 m, expected "
                          "one at least every 0.6 m"));
    EXPECT_THAT(ran({"compare", written("coarse.txt", "0\n0\n0\n"), whole, "--step", "0.5"}, 1).err,
                HasSubstr("coarse.txt: has a point every 0.5 m, expected at most 0.3 m"));
}

TEST_F(Compare, SaysThatIntervalsOverBothTracksAreTooNarrow) {
    std::string text{"HEAD3\nCMET3\nmaker,mm,both,50,mm\n\n\n"};
    for (int i = 0; i < 2000; ++i) {
        text += fmt::format("{},{}\n", i % 7, i % 5);
    }
    const auto page = (folder_ / "page.html").string();
    ran({"compare", written("a.pro", text), written("b.pro", text), "-o", page});
    EXPECT_THAT(read_file(page), HasSubstr("The tracks count as independent"));
    const auto one = profile(0, 1);
    ran({"compare", written("a.csv", one), written("b.csv", one), "-o", page});
    EXPECT_THAT(read_file(page), Not(HasSubstr("The tracks count as independent")));
}

TEST_F(Compare, RefusesOptionsWithoutEffectAndToReplaceTheRoads) {
    const auto refusal = [](std::vector<std::string> words, int exit_status = 2) {
        words.insert(words.begin(), "compare");
        return ran(words, exit_status).err;
    };
    const auto a = written("a.csv", profile(0, 1)), b = written("b.csv", profile(0, 1));
    EXPECT_THAT(refusal({a, b, "--way", "11"}), HasSubstr("--way selects roads or passes"));
    EXPECT_THAT(refusal({a, b, "--since", "2025-06"}),
                HasSubstr("--since selects roads or passes"));
    EXPECT_THAT(refusal({a, b, "--unit", "in/mi"}), HasSubstr("--unit is that of a survey"));
    EXPECT_THAT(refusal({store_, truth_, "--length", "10"}),
                HasSubstr("--length requires two profiles"));
    const auto other = (folder_ / "other.csv").string();
    fs::copy(truth_, other);
    EXPECT_THAT(refusal({truth_, other, "--roads", store_, "--until", "2025-06"}),
                HasSubstr("--until selects passes of a road database"));
    const auto roads = (folder_ / "roads.html").string();
    fs::copy(store_, roads);
    EXPECT_THAT(refusal({truth_, other, "--roads", roads, "-o", roads}, 1),
                HasSubstr("roads.html: is also an input"));
}

TEST_F(Compare, WritesASelfContainedPage) {
    const auto page = (folder_ / "page.html").string();
    EXPECT_THAT(ran({"compare", store_, truth_, "-o", page}).out, HasSubstr("shared segments"));
    const auto html = read_file(page);
    EXPECT_THAT(html, HasSubstr("<svg"));
    EXPECT_THAT(html, HasSubstr("not anonymised"));
    EXPECT_THAT(html, Not(HasSubstr("http://")));
    EXPECT_THAT(html, Not(HasSubstr("v-")));
    EXPECT_THAT(ran({"compare", store_, truth_, "-o", "page.png"}, 2).err,
                HasSubstr("expected a name that ends in .html, .pdf, .csv, .json, or --format"));
    EXPECT_THAT(ran({"compare", store_, truth_, "-o", store_ + ".html", "--car-b", "one"}, 2).err,
                HasSubstr("--car-b requires a road database"));
}

} // namespace
} // namespace macadam::testing
