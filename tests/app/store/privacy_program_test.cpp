// What a store and all that is handed on tell of the cars: `macadam` as users run it.

#include "estimator/vehicle/vehicle.hpp"
#include "support/program/program.hpp"
#include "support/roads/drive.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <map>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::SizeIs;
using Json = nlohmann::json;

const std::array<std::string, 2> ids{"WVWZZZ1JZXW000001", "Anna's blue van"};

/// A road driven by two cars on two days; the cars' ids stand in the logs and in their names.
class PrivacyProgram : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fresh_folder();
        store_ = (folder_ / "roads.gpkg").string();
        const auto road = patched_road([](double x_m) { return x_m > 300; }, 0.3);
        fs::create_directory(folder_ / "trips");
        for (std::size_t i = 0; i < ids.size(); ++i) {
            const Drive drive{.length_m = 600,
                              .trip_id = ids[i] + "-0001",
                              .vehicle_id = ids[i],
                              .t0_utc = fmt::format("2026-05-0{}T08:15:00Z", i + 1)};
            trips_.push_back((folder_ / "trips" / (drive.trip_id + ".trip.csv")).string());
            write_file(trips_.back(),
                       text_of(drive_over(road, drive, *built_in_vehicle("golden-car")), drive));
        }
        make_store();
    }

    void make_store() const {
        ASSERT_EQ(run_macadam({"init", store_, "--trace", trips_[0]}).exit_status, 0);
        EXPECT_EQ(import(trips_[0]).exit_status, 0);
        EXPECT_EQ(import(trips_[1]).exit_status, 0);
    }

    macadam::testing::Run import(const std::string& trip) const {
        return run_macadam({"import", store_, trip, "--vehicle", "golden-car", "--method", "kf"});
    }

    std::string out_of(std::vector<std::string> words) const {
        words.insert(words.begin() + 1, store_);
        const auto run = run_macadam(words);
        EXPECT_EQ(run.exit_status, 0) << run.err;
        return run.out + run.err;
    }

    /// All that the program hands on, by what it is called.
    std::map<std::string, std::string> handed_on() const {
        std::map<std::string, std::string> texts;
        for (const std::string format : {"table", "json", "csv", "geojson"}) {
            texts["segments as " + format] =
                out_of({"query", "--worst", "50", "--segments", "--format", format});
            texts["stretches as " + format] = out_of({"query", "--worst", "5", "--format", format});
        }
        for (const std::string format : {"table", "json", "csv"}) {
            texts["history as " + format] =
                out_of({"query", "--bbox", "10,47,12,49", "--history", "--format", format});
        }
        const auto out = folder_ / "out";
        fs::create_directories(out);
        for (const auto* const suffix : {".geojson",
                                         ".geojsonl",
                                         ".gpkg",
                                         ".csv",
                                         ".fgb",
                                         ".shp",
                                         ".kml",
                                         ".pmtiles",
                                         ".mbtiles"}) {
            out_of({"export", "-o", (out / ("roads" + std::string{suffix})).string()});
        }
        out_of({"report", "-o", (out / "report.html").string()});
        out_of({"report", "-o", (out / "report.pdf").string()});
        out_of({"render", "-o", (out / "map.pdf").string()});
        out_of({"render", "-o", (out / "map.png").string()});
        for (const auto& file : fs::directory_iterator{out}) {
            texts[file.path().filename()] = read_file(file.path());
        }
        texts["info"] = out_of({"info"});
        texts["info as JSON"] = out_of({"info", "--json"});
        texts["audit"] = out_of({"info", "--audit"});
        return texts;
    }

    fs::path folder_;
    std::string store_;
    std::vector<std::string> trips_;
};

TEST_F(PrivacyProgram, TellsNoIdOfACarAnywhere) {
    auto texts = handed_on();
    for (const auto& file : fs::directory_iterator{folder_}) {
        if (file.is_regular_file()) { // the store, its key and its network
            texts[file.path().filename()] = read_file(file.path());
        }
    }
    ASSERT_TRUE(texts.contains("roads.gpkg.key"));
    ASSERT_GE(texts.size(), 25U);
    for (const auto& [name, text] : texts) {
        for (const auto& id : ids) {
            EXPECT_EQ(text.find(id), std::string::npos) << name;
        }
    }
}

TEST_F(PrivacyProgram, HandsOnDaysAndNoTimes) {
    std::size_t with_day = 0;
    for (const auto& [name, text] : handed_on()) {
        for (const auto* const time : {"2026-05-01T08",
                                       "2026-05-02T08",
                                       "2026-05-01 08",
                                       "2026-05-02 08",
                                       "2026/05/01 08",
                                       "2026/05/02 08",
                                       "T08:1",
                                       " 08:1"}) {
            EXPECT_EQ(text.find(time), std::string::npos) << name << " " << time;
        }
        with_day += text.find("2026-05-01") != std::string::npos ? 1 : 0;
    }
    EXPECT_GE(with_day, 10U);
    const auto segments =
        Json::parse(out_of({"query", "--worst", "1", "--segments", "--format", "json"}));
    EXPECT_EQ(segments[0]["first_seen"], "2026-05-01");
    EXPECT_EQ(segments[0]["last_seen"], "2026-05-02");
}

TEST_F(PrivacyProgram, NumbersTheCarsOfAReportAndSaysThatItIsNotAnonymised) {
    const auto page = (folder_ / "report.html").string();
    out_of({"report", "-o", page});
    EXPECT_THAT(read_file(page), HasSubstr("is not anonymised"));
    EXPECT_THAT(read_file(page), Not(ContainsRegex("v-[0-9a-f]{12}")));
    const auto cars = Json::parse(out_of({"info", "--json"}))["cars"];
    ASSERT_THAT(cars, SizeIs(2));
    EXPECT_THAT(cars[0]["vehicle"].get<std::string>(), MatchesRegex("v-[0-9a-f]{32}"));
    EXPECT_EQ(cars[0]["number"].get<int>() + cars[1]["number"].get<int>(), 3);
}

TEST_F(PrivacyProgram, ShowsTheProfileAndRefusesOneThatIsNone) {
    EXPECT_EQ(Json::parse(out_of({"info", "--json"}))["privacy"], "own");
    EXPECT_THAT(out_of({"info"}),
                HasSubstr("privacy     own: the operator's cars, nothing is anonymised"));
    const auto wrong = run_macadam(
        {"init", (folder_ / "b.gpkg").string(), "--trace", trips_[0], "--privacy", "none"});
    EXPECT_EQ(wrong.exit_status, 2);
    EXPECT_THAT(wrong.err, HasSubstr("--privacy is 'none', expected own or crowd"));
}

TEST_F(PrivacyProgram, SaysThatOldCarsAreNotJoinedWhereTheKeyIsGone) {
    EXPECT_EQ(import(trips_[0]).err.find("warning"), std::string::npos);
    fs::remove(store_ + ".key");
    EXPECT_EQ(Json::parse(out_of({"info", "--json"}))["operator"], false);
    const auto run = import(trips_[0]);
    EXPECT_EQ(run.exit_status, 0);
    EXPECT_THAT(run.err,
                HasSubstr("roads.gpkg.key: was missing, so a new key was made; cars imported "
                          "from now on cannot be linked"));
    EXPECT_EQ(Json::parse(out_of({"info", "--json"}))["operator"], true);
}

TEST_F(PrivacyProgram, WarnsOfAKeyThatOthersCanRead) {
    fs::permissions(store_ + ".key", fs::perms::others_read, fs::perm_options::add);
    EXPECT_THAT(out_of({"info"}), HasSubstr("roads.gpkg.key: other users can read this key"));
}

TEST_F(PrivacyProgram, ForgetsACarByItsIdAndATripByItsFullName) {
    EXPECT_THAT(out_of({"forget", "--vehicle-id", ids[0]}),
                HasSubstr("1 trip permanently deleted"));
    EXPECT_THAT(out_of({"forget", "--trip", ids[1] + "-0001.trip.csv"}),
                HasSubstr("1 trip permanently deleted"));
}

} // namespace
} // namespace macadam::testing
