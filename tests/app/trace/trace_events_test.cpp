// `trace --events`, by the program itself.

#include "estimator/vehicle/vehicle_prior.hpp"
#include "storage/settings/vehicle_writer.hpp"
#include "support/program/program.hpp"
#include "support/roads/drive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::StartsWith;

constexpr double hole_at_m = 500;
constexpr double hole_length_m = 1;
constexpr double hole_depth_m = 0.03;

/// A drive of 800 m due east with one hole in its road.
class TraceEvents : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fresh_folder();
        const auto plain = patched_road([](double) { return false; }, 1);
        const auto road = [&](double at_m) {
            const double part = (at_m - hole_at_m) / hole_length_m + 0.5;
            const bool in_hole = part > 0 && part < 1;
            return plain(at_m) - (in_hole ? hole_depth_m * std::pow(std::sin(M_PI * part), 2) : 0);
        };
        auto car = *built_in_vehicle("golden-car");
        write_file(folder_ / "drive.trip.csv", text_of(drive_over(road, drive_, car), drive_));
        car.imu.lowpass_hz = no_lowpass_hz; // as it is simulated
        write_file(folder_ / "car.toml", vehicle_text(car));
    }

    std::string at(const std::string& name) const { return (folder_ / name).string(); }

    testing::Run trace(std::vector<std::string> more) const {
        std::vector<std::string> words{"trace", at("drive.trip.csv"), "--vehicle", at("car.toml")};
        words.insert(words.end(), more.begin(), more.end());
        return run_macadam(words);
    }

    const Drive drive_{.length_m = 800};
    fs::path folder_;
};

std::vector<std::string> split(const std::string& text, char at) {
    std::istringstream in{text};
    std::vector<std::string> parts;
    for (std::string part; std::getline(in, part, at);) {
        parts.push_back(part);
    }
    return parts;
}

} // namespace

/// A car with one axle has one track and sees the whole depth. Positions: within 2 m.
TEST_F(TraceEvents, WritesAHoleWithItsPlaceAndDepth) {
    const auto run = trace({"--events", at("events.csv")});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("events.csv: 1 event\n"));
    const auto lines = split(read_file(at("events.csv")), '\n');
    ASSERT_THAT(lines, SizeIs(2));
    EXPECT_EQ(lines[0],
              "kind,severity,track,size_mm,size_sd_mm,length_m,travel_m,t_s,lat_deg,lon_deg,"
              "speed_mps,score");
    EXPECT_THAT(lines[1], StartsWith("pothole,moderate,unknown,"));
    const auto cells = split(lines[1], ',');
    ASSERT_THAT(cells, SizeIs(12));
    EXPECT_NEAR(std::stod(cells[3]), 1000 * hole_depth_m, 2 * std::stod(cells[4]));
    const auto truth = place_of(drive_, hole_at_m);
    constexpr double m_per_deg = 111'320;
    EXPECT_LT(m_per_deg * std::abs(std::stod(cells[8]) - truth.lat_deg), 2);
    EXPECT_LT(m_per_deg * std::cos(0.84) * std::abs(std::stod(cells[9]) - truth.lon_deg), 2);
}

TEST_F(TraceEvents, WritesJsonAndPointsOfGeoJson) {
    ASSERT_EQ(trace({"--events", at("events.json")}).exit_status, 0);
    ASSERT_EQ(trace({"--events", at("events.geojson")}).exit_status, 0);
    EXPECT_THAT(read_file(at("events.json")),
                AllOf(StartsWith("[{\"kind\":\"pothole\",\"severity\":\"moderate\","),
                      HasSubstr("\"lat_deg\":48.0")));
    EXPECT_THAT(read_file(at("events.geojson")),
                AllOf(StartsWith("{\"type\":\"FeatureCollection\",\"features\":["),
                      HasSubstr("{\"type\":\"Point\",\"coordinates\":[11.0"),
                      HasSubstr("\"kind\":\"pothole\"")));
}

TEST_F(TraceEvents, RefusesWhatCannotBe) {
    EXPECT_THAT(trace({"--events", at("events.txt")}).err,
                HasSubstr("expected a name that ends in .csv, .json, .geojson"));
    const auto filter = trace({"--method", "kf", "--events", at("events.csv")});
    EXPECT_EQ(filter.exit_status, 2);
    EXPECT_THAT(filter.err, HasSubstr("--events requires --method smoother"));
    EXPECT_THAT(trace({"--live", "--events", at("events.csv")}).err,
                HasSubstr("--live and --events cannot be combined"));
    const auto lateral = trace({"--channels", "lateral", "--events", at("events.csv")});
    EXPECT_EQ(lateral.exit_status, 1);
    EXPECT_THAT(lateral.err, HasSubstr("expected vertical acceleration for --events"));
    const auto twice = trace({"--events", at("events.csv"), "-o", at("events.csv")});
    EXPECT_EQ(twice.exit_status, 2);
    EXPECT_THAT(twice.err, HasSubstr("events.csv is given for two outputs"));
    EXPECT_FALSE(fs::exists(at("events.csv")));
}

} // namespace macadam::testing
