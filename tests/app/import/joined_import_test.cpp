// Trips whose sensors and positions come in two files, from import to query.

#include "storage/trips/trip_reader.hpp"
#include "support/program/places.hpp"
#include "support/program/program.hpp"
#include "support/roads/walked_trips.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using Json = nlohmann::json;

const fs::path root{source_folder()};
const std::string drive = (root / "sample_data/gyor/gyor_q3_00.trip.csv").string();

/// A recorded drive near Győr, and a database of its roads.
class JoinedImport : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fresh_folder();
        fs::create_directory(folder_ / "trips");
        store_ = (folder_ / "roads.gpkg").string();
        run({"init", store_, "--trace", drive});
        trip_ = read_trip({.file = drive, .member = {}},
                          {.acc = true, .gyro = false, .speed = false, .fixes = true});
    }

    static std::string run(const std::vector<std::string>& words) {
        const auto result = run_macadam(words);
        EXPECT_EQ(result.exit_status, 0) << words[0] << ": " << result.err;
        return result.out;
    }

    /// Accelerations as a table.
    std::string sensor_rows(const std::string& header) const {
        std::string text = header;
        for (std::size_t i = 0; i < trip_.acc.t_s.size(); ++i) {
            text += fmt::format("{:.6f},{},{},{}\n",
                                trip_.acc.t_s[i],
                                trip_.acc.x[i],
                                trip_.acc.y[i],
                                trip_.acc.z[i]);
        }
        return text;
    }

    std::string at(const std::string& name) const { return (folder_ / name).string(); }

    /// Imports with the Kalman filter, which is fast. \returns the line about the trip.
    static Json imported(std::vector<std::string> words) {
        words.insert(words.begin(), "import");
        words.insert(words.end(), {"--method", "kf", "--json"});
        const auto out = run(words);
        return Json::parse(out.substr(0, out.find('\n')));
    }

    /// Expects in a database what it has if the drive comes in one file.
    void expect_the_drive() const {
        const auto whole = at("whole.gpkg");
        run({"init", whole, "--trace", drive});
        imported({whole, drive});
        const auto expected = Json::parse(run({"query", whole, "--way", "1", "--json"}));
        const auto rows = Json::parse(run({"query", store_, "--way", "1", "--json"}));
        ASSERT_GE(expected.size(), 50U);
        EXPECT_NEAR(double(rows.size()), double(expected.size()), 2);
        const auto mean = [](const Json& of) {
            double sum = 0;
            for (const auto& row : of) {
                sum += double(row.at("iri"));
            }
            return sum / double(of.size());
        };
        EXPECT_NEAR(mean(rows) / mean(expected), 1, 0.02); // speeds are up to 0.3 s apart
    }

    fs::path folder_;
    std::string store_;
    TripLog trip_;
};

TEST_F(JoinedImport, OfNmeaBesideALogGivesTheRoadsOfTheDrive) {
    write_file(at("trips/drive.trip.csv"),
               sensor_rows("# macadam-trip 1\n# frame: FLU\n"
                           "t_s,acc_x_mps2,acc_y_mps2,acc_z_mps2\n") +
                   fmt::format("# end rows: {}\n", trip_.acc.t_s.size()));
    fs::copy_file(root / "tests/data/positions/gyor.nmea", at("trips/drive.nmea"));
    const auto line = imported({store_, at("trips")});
    EXPECT_EQ(line.at("result"), "imported");
    EXPECT_THAT(line.at("warnings").dump(), HasSubstr("positions of drive.nmea, 3.0"));
    expect_the_drive();
}

TEST_F(JoinedImport, OfTwoTablesByAnInspectedMappingGivesTheRoadsOfTheDrive) {
    write_file(at("trips/imu.csv"), sensor_rows("time,ax,ay,az\n"));
    std::string positions = "time,lat,lon,speed\n";
    for (const auto& fix : trip_.fixes) {
        positions += fmt::format(
            "{:.6f},{:.8f},{:.8f},{}\n", fix.t_s, fix.at.lat_deg, fix.at.lon_deg, fix.speed_mps);
    }
    for (auto found = positions.find("nan"); found != std::string::npos;
         found = positions.find("nan")) {
        positions.erase(found, 3);
    }
    write_file(at("trips/gnss.csv"), positions);
    const auto mapping = at("logger.toml");
    run({"inspect", at("trips/imu.csv"), at("trips/gnss.csv"), "-o", mapping});
    const auto line = imported({store_, at("trips"), "--mapping", mapping});
    EXPECT_EQ(line.at("result"), "imported");
    EXPECT_GE(int(line.at("passes")), 50);
    expect_the_drive();
    EXPECT_EQ(imported({store_, at("trips"), "--mapping", mapping}).at("result"), "known");
}

} // namespace
} // namespace macadam::testing
