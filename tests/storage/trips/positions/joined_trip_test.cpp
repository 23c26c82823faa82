#include "storage/trips/positions/joined_trip.hpp"

#include "estimator/clocks/clock_offset.hpp"
#include "storage/trips/trip_reader.hpp"
#include "support/files/files.hpp"
#include "support/program/places.hpp"
#include "support/roads/walked_trips.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const TripNeeds everything{.acc = true, .gyro = true, .speed = true, .fixes = true};
const fs::path root{source_folder()};

TripLog gyor() {
    return read_trip({.file = root / "sample_data/gyor/gyor_q3_00.trip.csv", .member = {}},
                     everything);
}

/// The sensors of the drive near Győr without its positions, as a log of our own.
std::string sensors_only(const TripLog& trip, const std::string& head = "") {
    std::string rows;
    for (std::size_t i = 0; i < trip.acc.t_s.size(); ++i) {
        rows += fmt::format(
            "{:.6f},{},{},{}\n", trip.acc.t_s[i], trip.acc.x[i], trip.acc.y[i], trip.acc.z[i]);
    }
    return fmt::format("# macadam-trip 1\n# frame: sensor\n{}t_s,acc_x_mps2,acc_y_mps2,acc_z_mps2\n"
                       "{}# end rows: {}\n",
                       head,
                       rows,
                       trip.acc.t_s.size());
}

std::vector<GnssFix> shifted(std::vector<GnssFix> fixes, double by_s) {
    for (auto& fix : fixes) {
        fix.t_s += by_s;
    }
    return fixes;
}

/// Accelerations and turns that change at random every few seconds, and the fixes of this drive.
TripLog wandering(std::uint64_t seed, double duration_s) {
    constexpr double step_s = 0.02;
    std::mt19937_64 random{seed};
    std::normal_distribution<double> normal;
    TripLog trip;
    double speed_mps = 15;
    double course_rad = 0;
    double pull_mps2 = 0;
    double turn_radps = 0;
    for (int i = 0; i * step_s < duration_s; ++i) {
        const double t_s = i * step_s;
        if (i % 200 == 0) {
            pull_mps2 = 0.8 * normal(random) - 0.1 * (speed_mps - 15);
            turn_radps = 0.1 * normal(random);
        }
        if (i % 50 == 0) {
            trip.fixes.push_back(
                {.t_s = t_s,
                 .at = {47, 8 + t_s * 1e-4},
                 .speed_mps = static_cast<float>(speed_mps),
                 .course_deg = static_cast<float>(std::fmod(course_rad * 57.29578 + 3600, 360)),
                 .accuracy_m = NAN});
        }
        trip.acc.t_s.push_back(t_s);
        trip.acc.x.push_back(static_cast<float>(pull_mps2 + 0.3 * normal(random)));
        trip.acc.y.push_back(static_cast<float>(-speed_mps * turn_radps + 0.3 * normal(random)));
        trip.acc.z.push_back(static_cast<float>(9.81 + 0.5 * normal(random)));
        speed_mps = std::max(4.0, speed_mps + pull_mps2 * step_s);
        course_rad += turn_radps * step_s;
    }
    return trip;
}

TEST(ClockOffset, IsFoundWithinItsUncertaintyFromAccelerationAlone) {
    for (const double truth_s : {-400.3, 12.34}) {
        const auto trip = wandering(1, 150);
        const auto search = find_clock_offset(trip, shifted(trip.fixes, -truth_s), {});
        ASSERT_TRUE(search.found) << search.words;
        EXPECT_NEAR(search.found->offset_s, truth_s, 4 * search.found->sd_s);
        EXPECT_LT(search.found->sd_s, 0.15);
    }
}

TEST(ClockOffset, IsFoundWhateverWayTheSensorLies) {
    auto trip = wandering(2, 150);
    std::swap(trip.acc.x, trip.acc.z);
    for (auto& y : trip.acc.y) {
        y = -y;
    }
    const auto search = find_clock_offset(trip, shifted(trip.fixes, -7), {});
    ASSERT_TRUE(search.found) << search.words;
    EXPECT_NEAR(search.found->offset_s, 7, 4 * search.found->sd_s);
}

TEST(ClockOffset, IsNotFoundBetweenTwoDrives) {
    for (std::uint64_t seed = 10; seed < 13; ++seed) {
        const auto search =
            find_clock_offset(wandering(seed, 150), wandering(seed + 100, 150).fixes, {});
        EXPECT_FALSE(search.found) << seed << " " << search.found->offset_s;
    }
}

TEST(ClockOffset, IsAmbiguousWhereADriveRepeatsItself) {
    auto trip = wandering(3, 120);
    const auto once = trip;
    for (std::size_t i = 0; i < once.acc.t_s.size(); ++i) {
        trip.acc.t_s.push_back(once.acc.t_s[i] + 120);
        trip.acc.x.push_back(once.acc.x[i]);
        trip.acc.y.push_back(once.acc.y[i]);
        trip.acc.z.push_back(once.acc.z[i]);
    }
    const auto search = find_clock_offset(trip, once.fixes, {});
    EXPECT_FALSE(search.found);
    EXPECT_THAT(search.words, HasSubstr("fit about as well"));
}

TEST(ClockOffset, SaysWhyThereIsNone) {
    const auto trip = wandering(4, 120);
    EXPECT_THAT(find_clock_offset({}, trip.fixes, {}).words, HasSubstr("has neither speed"));
    EXPECT_THAT(find_clock_offset(trip, {}, {}).words, HasSubstr("too few"));
}

TEST(JoinedTrip, TakesItsPositionsFromTheFileBesideIt) {
    const auto folder = test_folder();
    const auto original = gyor();
    written(folder, "drive.trip.csv", sensors_only(original));
    fs::copy_file(root / "tests/data/positions/gyor.nmea", folder / "drive.nmea");
    const auto found = find_trips(folder);
    ASSERT_THAT(found.trips, SizeIs(1));
    EXPECT_EQ(found.other_files, 0U);
    const auto trip = read_trip(found.trips[0], needs_of_import());
    ASSERT_THAT(trip.fixes, SizeIs(125));
    EXPECT_THAT(trip.acc.t_s, SizeIs(original.acc.t_s.size()));
    // The receiver's speeds were 0.55 s late, as its stamps and the acceleration of one clock say.
    const auto& first = *std::ranges::find_if(
        original.fixes, [](const GnssFix& fix) { return !std::isnan(fix.speed_mps); });
    EXPECT_NEAR(trip.fixes[0].t_s, first.t_s - 0.55, 0.25);
    EXPECT_FALSE(trip.meta.gnss_latency_stated);
    EXPECT_THAT(trip.meta.other.at(positions_key), HasSubstr("positions of drive.nmea, 3.0"));
    EXPECT_NEAR(*trip.meta.t0_utc_s, 1772352000, 1.5); // date -d 2026-03-01T08:00:00Z +%s
    const auto rows = account(trip,
                              {.acc = SampleUse(trip.acc.t_s.size()),
                               .gyro = SampleUse(trip.gyro.t_s.size()),
                               .speed = SampleUse(trip.speed.t_s.size()),
                               .fixes = SampleUse(trip.fixes.size())});
    EXPECT_EQ(rows.read, original.acc.t_s.size() + 500); // and the sentences
    EXPECT_EQ(rows.used, original.acc.t_s.size() + 125);
}

TEST(JoinedTrip, TakesTheTimesThatBothState) {
    const auto folder = test_folder();
    const auto log = written(
        folder, "drive.trip.csv", sensors_only(gyor(), "# t0_utc: 2026-03-01T08:00:00.000Z\n"));
    fs::copy_file(root / "tests/data/positions/gyor.nmea", folder / "positions.nmea");
    const auto found = walked(log, {.positions = folder / "positions.nmea"});
    const auto trip = read_trip(found.trips.at(0), needs_of_import());
    ASSERT_THAT(trip.fixes, SizeIs(125));
    EXPECT_NEAR(trip.fixes[0].t_s, 3.514, 1e-6);
    EXPECT_FALSE(trip.meta.gnss_latency_stated);
    EXPECT_THAT(trip.meta.other.at(positions_key), EndsWith("the times that both state"));
}

TEST(JoinedTrip, DoubtsStatedTimesWhereTheMotionTellsOtherwise) {
    for (const double wrong_s : {-18.0, 18.0}) { // GPS time taken for UTC
        auto log = wandering(5, 150);
        TripLog positions;
        positions.fixes = log.fixes;
        log.fixes.clear();
        log.meta.t0_utc_s = 1772352000;
        positions.meta.t0_utc_s = *log.meta.t0_utc_s + wrong_s;
        const auto joined = joined_trip(log, positions, everything, "p.gpx", {});
        EXPECT_NEAR(joined.fixes.front().t_s, wrong_s, 1e-6); // as stated, but not in silence
        EXPECT_THAT(joined.meta.other.at(positions_key),
                    AllOf(HasSubstr(wrong_s > 0 ? "18.0 s earlier" : "18.0 s later"),
                          HasSubstr("one of the clocks is likely wrong; leave t0_utc out")));
    }
}

TEST(JoinedTrip, RefusesPositionsOfAnotherDay) {
    const auto folder = test_folder();
    const auto log = written(
        folder, "drive.trip.csv", sensors_only(gyor(), "# t0_utc: 2026-03-02T08:00:00.000Z\n"));
    fs::copy_file(root / "tests/data/positions/gyor.nmea", folder / "drive.nmea");
    EXPECT_THAT(
        refusal_of([&] { read_trip(find_trips(log).trips.at(0), needs_of_import()); }),
        HasSubstr("has positions from 2026-03-01T08:00:03.514Z to 2026-03-01T08:02:07.820Z, "
                  "expected some from 2026-03-02T08:00:00Z"));
}

TEST(JoinedTrip, HasTheHashOfBothFiles) {
    const auto folder = test_folder();
    written(folder, "drive.trip.csv", sensors_only(gyor()));
    fs::copy_file(root / "tests/data/positions/gyor.nmea", folder / "drive.nmea");
    const auto one = OpenTrip{find_trips(folder).trips.at(0)}.sha256();
    EXPECT_EQ(OpenTrip{find_trips(folder).trips.at(0)}.sha256_ahead(), one);
    fs::rename(folder / "drive.nmea", folder / "p.nmea");
    const auto named = walked(folder / "drive.trip.csv", {.positions = folder / "p.nmea"});
    EXPECT_EQ(OpenTrip{named.trips.at(0)}.sha256(), one);
    written(folder, "p.nmea", "$GPRMC,100000,A,4730,N,00815,E,10,90,010526,,*57\n");
    EXPECT_NE(OpenTrip{named.trips.at(0)}.sha256(), one);
}

TEST(JoinedTrip, LeavesALogWithPositionsAlone) {
    const auto folder = test_folder();
    fs::copy_file(root / "sample_data/gyor/gyor_q3_00.trip.csv", folder / "drive.trip.csv");
    fs::copy_file(root / "tests/data/positions/gyor.nmea", folder / "drive.nmea");
    EXPECT_TRUE(find_trips(folder).trips.at(0).positions.empty());
    EXPECT_THAT(find_tracks(folder).trips, SizeIs(2));
}

TEST(JoinedTrip, ReadsADetectedCsvBesideATrack) {
    const auto folder = test_folder();
    const auto trip = gyor();
    std::string rows = "time_s,ax (m/s2),ay (m/s2),az (m/s2)\n";
    for (std::size_t i = 0; i < trip.acc.t_s.size(); ++i) {
        rows += fmt::format("{:.4f},{:.4f},{:.4f},{:.4f}\n",
                            trip.acc.t_s[i],
                            trip.acc.x[i],
                            trip.acc.y[i],
                            trip.acc.z[i]);
    }
    written(folder, "drive.csv", rows);
    fs::copy_file(root / "tests/data/positions/gyor.nmea", folder / "drive.nmea");
    for (const auto& found : {find_trips(folder), find_tracks(folder)}) {
        ASSERT_THAT(found.trips, SizeIs(1));
        EXPECT_EQ(found.trips[0].positions, folder / "drive.nmea");
        EXPECT_THAT(read_trip(found.trips[0], needs_of_import()).fixes, SizeIs(125));
    }
}

TEST(JoinedTrip, RefusesOnePositionsFileForSeveralLogs) {
    const auto folder = test_folder();
    written(folder, "a.trip.csv", "");
    written(folder, "b.trip.csv", "");
    const auto found = walked(folder, {.positions = folder / "p.nmea"});
    ASSERT_THAT(found.trips, SizeIs(2));
    EXPECT_THAT(refusal_of([&] { OpenTrip{found.trips[0]}.read(everything); }),
                HasSubstr("is one of several trips"));
}

} // namespace
} // namespace macadam::testing
