// `identify`, by the program itself, on a drive of a simulated two-axle car.

#include "estimator/identification/rides.hpp"
#include "estimator/simulation/linear_ride.hpp"
#include "estimator/vehicle/vehicle_prior.hpp"
#include "storage/settings/vehicle_file.hpp"
#include "storage/settings/vehicle_writer.hpp"
#include "support/program/program.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <filesystem>
#include <iterator>
#include <string>
#include <tuple>
#include <vector>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr double first_station_m = 1000; // of the profile; the trip starts there

std::string trip_text(const Stretch& stretch) {
    std::string text = "# macadam-trip 1\n# frame: FLU\n# gravity: included\n# vehicle_id: mine\n"
                       "t_s,acc_y_mps2,acc_z_mps2,speed_mps\n";
    auto out = std::back_inserter(text);
    for (std::size_t i = 0; i < stretch.travel_m.size(); ++i) {
        fmt::format_to(out,
                       "{:.3f},{:.5f},{:.5f},{:.4f}\n",
                       static_cast<double>(i) * stretch.step_s,
                       stretch.lateral_mps2[i],
                       stretch.vertical_mps2[i] + 9.80665F,
                       stretch.speed_mps[i]);
    }
    fmt::format_to(out, "# end rows: {}\n", stretch.travel_m.size());
    return text;
}

std::string profile_text(const RoadProfile& profile) {
    std::string text = "station_m,left_m,right_m\n";
    auto out = std::back_inserter(text);
    for (std::size_t i = 0; i < profile.station_m.size(); i += 2) {
        fmt::format_to(out,
                       "{:.2f},{:.6f},{:.6f}\n",
                       first_station_m + profile.station_m[i],
                       profile.left_m[i],
                       profile.right_m[i]);
    }
    return text;
}

class Identify : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fresh_folder();
        write_drive(0);
        write_car(no_lowpass_hz);
        write_file(folder_ / "road.csv", profile_text(profile_of(surface())));
    }

    /// A drive of 36 s at 50 Hz, of a sensor with this low-pass; 0: none.
    void write_drive(double lowpass_hz) const {
        write_file(
            folder_ / "drive.trip.csv",
            trip_text(two_axle_ride(car(), surface(), steady_motion(15, 36), 50, lowpass_hz)));
    }

    /// The car's file, which states this low-pass, or 0: does not state one.
    void write_car(double lowpass_hz) const {
        auto vehicle = car().vehicle;
        vehicle.imu.lowpass_hz = lowpass_hz;
        write_file(folder_ / "mine.toml", vehicle_text(vehicle));
    }

    std::string at(const char* name) const { return (folder_ / name).string(); }

    testing::Run identify(std::vector<std::string> more) const {
        std::vector<std::string> words{"identify",
                                       at("drive.trip.csv"),
                                       "--profile",
                                       at("road.csv"),
                                       "--vehicle",
                                       at("mine.toml")};
        words.insert(words.end(), more.begin(), more.end());
        return run_macadam(words);
    }

    std::filesystem::path folder_;

private:
    static CarRecipe car() {
        auto recipe = linear_car();
        recipe.vehicle.name = "mine";
        recipe.vehicle.axles = Axles{.wheelbase_m = 2.65, .cg_to_front_m = 1.325};
        return recipe;
    }

    static RoadSurface surface() { return make_surface({.iri_mm_per_m = 4}, 560, 5); }
};

TEST_F(Identify, SaysBySpectrumWhatItFoundAndWhatTheGainMeans) {
    const auto run = identify({"--method", "spectrum"});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("(located: the correlation of estimated and measured profile"));
    EXPECT_THAT(run.out, HasSubstr("ks_n_per_m         15825"));
    EXPECT_THAT(run.out,
                HasSubstr("The rms of this comb filter is 0.71, whatever the wheelbase. The "
                          "gain therefore reflects the wheelbase,\nnot a modern suspension"));
    EXPECT_EQ(run.err, "");
}

TEST_F(Identify, FindsThePlaceWithinAMetre) {
    const auto run = identify({"--method", "spectrum", "--json"});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    const auto found = run.out.find("\"at_m\":");
    ASSERT_NE(found, std::string::npos);
    EXPECT_NEAR(std::stod(run.out.substr(found + 7)), first_station_m, 1);
}

TEST_F(Identify, TakesThePlaceThatItIsTold) {
    const auto run = identify({"--method", "spectrum", "--at", "1000"});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    EXPECT_THAT(run.out, StartsWith("travel 0 is at station 1000.00 m (as given)\n"));
}

TEST_F(Identify, TellsEachParameterWithItsUncertaintyAndWhatTheDriveDidNotExcite) {
    const auto run = identify({});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("ms_kg is right"));
    EXPECT_THAT(run.out, HasSubstr("\ncs_ns_per_m "));
    EXPECT_THAT(run.out, HasSubstr("\ncorrelation "));
    EXPECT_THAT(run.out, HasSubstr("Vertical acceleration of the body: the model leaves "));
    // Without a gyroscope, the ends of a car cannot be told apart well.
    EXPECT_THAT(run.err, StartsWith("macadam: warning: the drive did not excite "));
    EXPECT_THAT(run.err, HasSubstr("dynamic_index"));
}

TEST_F(Identify, FindsTheCarThatDrove) {
    const auto run = identify({"-o", at("found.toml")});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    const auto found = read_vehicle(folder_ / "found.toml");
    EXPECT_EQ(found.name, "mine");
    EXPECT_EQ(found.half_car.ms_kg, 1600);
    EXPECT_FALSE(found.one_axle_gain);
    for (const auto& [key, value, truth] : {std::tuple{"gain", found.gain, 1.0},
                                            {"ks_n_per_m", found.half_car.ks_n_per_m, 30000.0},
                                            {"cs_ns_per_m", found.half_car.cs_ns_per_m, 2500.0},
                                            {"kt_n_per_m", found.half_car.kt_n_per_m, 250000.0}}) {
        ASSERT_TRUE(found.uncertainty.contains(key)) << key;
        const double sd = found.uncertainty.at(key);
        EXPECT_LT(sd, 0.1) << key;
        EXPECT_NEAR(value / truth, 1, 3 * sd) << key;
    }
    EXPECT_THAT(read_file(folder_ / "found.toml"),
                StartsWith("# Identified by 'macadam identify --method likelihood' from "));
}

// A damper that stands in for the sensor's low-pass would have it removed twice by `import`.
TEST_F(Identify, FindsTheSameCarBehindTheUsualLowpassWhereTheFileStatesNone) {
    constexpr double usual_hz = 20;    // 0.4 of the rate
    constexpr double tolerance = 0.02; // of a damper; 0.1 and more where it stands in
    for (const char* method : {"likelihood", "spectrum"}) {
        const auto found_behind = [&](double sensor_hz, double stated_hz) {
            write_drive(sensor_hz);
            write_car(stated_hz);
            const auto run = identify({"--method", method, "--at", "1000", "-o", at("found.toml")});
            EXPECT_EQ(run.exit_status, 0) << run.err;
            return read_vehicle(folder_ / "found.toml");
        };
        const auto without = found_behind(0, no_lowpass_hz);
        const auto behind = found_behind(usual_hz, 0);
        EXPECT_NEAR(behind.half_car.cs_ns_per_m / without.half_car.cs_ns_per_m, 1, tolerance)
            << method;
        EXPECT_EQ(without.imu.lowpass_hz, no_lowpass_hz) << method;
        EXPECT_NEAR(behind.imu.lowpass_hz, usual_hz, 0.01) << method; // as `import` assumes
    }
}

TEST_F(Identify, TellsTheSameAsJson) {
    const auto run = identify({"--json"});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("\"method\":\"likelihood\""));
    EXPECT_THAT(run.out, HasSubstr("\"parameter_correlation\":{\"mu_kg\":{\"mu_kg\":1.000,"));
    EXPECT_THAT(run.out, HasSubstr("\"relative_sd_given_mass\":"));
    EXPECT_THAT(run.out, HasSubstr("\"not_excited\":[\""));
    EXPECT_THAT(run.out, HasSubstr("\"settled\":"));
}

TEST_F(Identify, WritesARowForEachParameter) {
    const auto file = at("table.csv");
    const auto run = identify({"--method", "spectrum", "-o", at("found.toml"), file});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_THAT(read_file(file), StartsWith("parameter,start,found,relative_sd\nks_n_per_m,"));
    EXPECT_THAT(read_file(file), HasSubstr("\ngain,1.0000,"));
    EXPECT_THAT(read_file(at("found.toml")), HasSubstr("[half_car]"));
}

TEST_F(Identify, FitsACarWithoutAxlesByItsSpectrumAndSaysSo) {
    const auto run = run_macadam({"identify",
                                  at("drive.trip.csv"),
                                  "--profile",
                                  at("road.csv"),
                                  "--at",
                                  "1000",
                                  "--vehicle",
                                  "generic"});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("vehicle 'generic' has no [axles]: fitted with one axle"));
    EXPECT_THAT(run.out, HasSubstr("vertical spectra differ by "));
}

TEST_F(Identify, RefusesTheLikelihoodOfACarWithoutAxles) {
    const auto run = run_macadam({"identify",
                                  at("drive.trip.csv"),
                                  "--profile",
                                  at("road.csv"),
                                  "--at",
                                  "1000",
                                  "--vehicle",
                                  "generic",
                                  "--method",
                                  "likelihood"});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("vehicle 'generic' has no [axles], which --method likelihood"));
}

TEST_F(Identify, LeavesAVehicleThatReadsBack) {
    const auto run = identify({"--method", "spectrum", "-o", at("found.toml")});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    const auto found = read_vehicle(folder_ / "found.toml");
    EXPECT_EQ(found.name, "mine");
    EXPECT_EQ(found.half_car.ms_kg, 1600);
    EXPECT_EQ(found.gain, 1);
    ASSERT_TRUE(found.one_axle_gain);
    EXPECT_GT(*found.one_axle_gain, 0.65);
    EXPECT_LT(*found.one_axle_gain, 0.9);
    EXPECT_TRUE(found.uncertainty.contains("ks_n_per_m"));
}

TEST_F(Identify, LeavesAFigureOfBothChannelsThatNeedsNothingElse) {
    const auto run = identify({"--method", "spectrum", "-o", at("found.toml"), at("spectra.svg")});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    const auto svg = read_file(folder_ / "spectra.svg");
    EXPECT_THAT(svg, StartsWith("<svg xmlns=\"http://www.w3.org/2000/svg\""));
    EXPECT_THAT(svg, HasSubstr("Vertical acceleration of the body"));
    EXPECT_THAT(svg, HasSubstr("Lateral acceleration of the body"));
    EXPECT_THAT(svg, HasSubstr("frequency, Hz"));
    EXPECT_THAT(svg, HasSubstr("model, fitted"));
    EXPECT_THAT(svg, Not(HasSubstr("href")));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "found.toml"));
}

TEST_F(Identify, RefusesARoadThatTheTripWasNotOn) {
    write_file(folder_ / "road.csv", profile_text(profile_of(make_surface({}, 900, 99))));
    const auto run = identify({});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("drive.trip.csv: cannot be located on "));
    EXPECT_THAT(run.err, HasSubstr("expected 0.50, or --at METRE"));
}

TEST_F(Identify, RefusesAPlaceWhereNothingOfTheProfileLies) {
    const auto run = identify({"--at", "5000"});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("has no driving on "));
    EXPECT_THAT(run.err, HasSubstr("whose stations go from 1000.0 to 1560.0 m"));
}

TEST_F(Identify, RefusesToReplaceWhatItReads) {
    const auto profile = at("road.csv");
    std::filesystem::rename(profile, folder_ / "road.svg");
    const auto run = run_macadam(
        {"identify", at("drive.trip.csv"), "--profile", at("road.svg"), "-o", at("road.svg")});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("road.svg"));
    EXPECT_THAT(read_file(folder_ / "road.svg"), StartsWith("station_m"));
}

TEST_F(Identify, AsksForTheProfileInWords) {
    const auto run = run_macadam({"identify", at("drive.trip.csv")});
    EXPECT_EQ(run.exit_status, 2);
    EXPECT_THAT(run.err, HasSubstr("--profile FILE is missing: the measured profile of the road"));
}

TEST_F(Identify, TellsWhatItCanWrite) {
    const auto run = identify({"-o", "spectra.png"});
    EXPECT_EQ(run.exit_status, 2);
    EXPECT_THAT(run.err,
                HasSubstr("-o is 'spectra.png', expected a name that ends in .toml, .svg, .csv, "
                          ".json, or --format"));
    EXPECT_THAT(identify({"-o", "a.csv", "b.json"}).err,
                HasSubstr("-o names two files of rows, 'a.csv' and 'b.json'"));
}

} // namespace
} // namespace macadam::testing
