// Imports that are stopped or killed half-way, and what the next one makes of them.

#include "support/program/program.hpp"
#include "support/roads/drive.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <csignal>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int trip_count = 6;

/// Long enough that the first trip is told of well before the last is read.
void write_trips(const fs::path& folder) {
    fs::create_directories(folder);
    Drive drive{.length_m = 6000};
    const auto trip = drive_over(
        patched_road([](double) { return false; }, 1), drive, *built_in_vehicle("golden-car"));
    for (int i = 0; i < trip_count; ++i) {
        drive.trip_id = fmt::format("trip-{}", i);
        write_file(folder / (drive.trip_id + ".trip.csv"), text_of(trip, drive));
    }
}

struct World {
    fs::path trips;
    fs::path store;
};

World world() {
    const auto folder = fresh_folder();
    World made{folder / "trips", folder / "roads.gpkg"};
    write_trips(made.trips);
    const auto first = (made.trips / "trip-0.trip.csv").string();
    EXPECT_EQ(run_macadam({"init", made.store.string(), "--trace", first}).exit_status, 0);
    return made;
}

std::string digest_of(const fs::path& store) {
    return run_macadam({"info", store.string(), "--digest"}).out;
}

/// Of the same import without a break.
std::string whole_digest(const World& made) {
    const auto store = made.store.parent_path() / "whole.gpkg";
    const auto first = (made.trips / "trip-0.trip.csv").string();
    run_macadam({"init", store.string(), "--trace", first});
    run_macadam({"import", store.string(), made.trips.string(), "--method", "kf"});
    return digest_of(store);
}

Run import_until(const World& made, int signal) {
    return run_macadam_signalled(
        {"import", made.store.string(), made.trips.string(), "--method", "kf", "--jobs", "1"},
        "trip-0.trip.csv",
        signal);
}

TEST(InterruptedImport, EndsInOrderWhenAskedToStop) {
    const auto made = world();
    const auto stopped = import_until(made, SIGINT);
    EXPECT_EQ(stopped.exit_status, 1);
    EXPECT_THAT(stopped.err, HasSubstr("macadam import: interrupted: "));
    EXPECT_THAT(stopped.err, HasSubstr(" of 6 trips were not read"));
    // What came in is fused already: nothing waits.
    EXPECT_THAT(run_macadam({"query", made.store.string(), "--worst", "1"}).err,
                Not(HasSubstr("waiting")));
}

TEST(InterruptedImport, GoesOnWithTheRestAndSaysSo) {
    const auto made = world();
    import_until(made, SIGTERM);
    const auto resumed =
        run_macadam({"import", made.store.string(), made.trips.string(), "--method", "kf"});
    EXPECT_EQ(resumed.exit_status, 0);
    EXPECT_THAT(resumed.err,
                HasSubstr("an earlier import of these paths (6 trips) was "
                          "interrupted"));
    EXPECT_THAT(resumed.out, HasSubstr("skipped   "));
    EXPECT_EQ(digest_of(made.store), whole_digest(made));

    const auto again =
        run_macadam({"import", made.store.string(), made.trips.string(), "--method", "kf"});
    EXPECT_THAT(again.err, Not(HasSubstr("was interrupted")));
    EXPECT_THAT(again.err, HasSubstr("0 trips imported, 6 already imported"));
}

TEST(InterruptedImport, LosesNothingThatItReportedWhenKilled) {
    const auto made = world();
    const auto killed = import_until(made, SIGKILL);
    EXPECT_EQ(killed.exit_status, 128 + SIGKILL);
    const auto resumed =
        run_macadam({"import", made.store.string(), made.trips.string(), "--method", "kf"});
    EXPECT_EQ(resumed.exit_status, 0);
    EXPECT_THAT(resumed.err, HasSubstr("was interrupted"));
    EXPECT_THAT(resumed.out, HasSubstr("skipped   " + (made.trips / "trip-0.trip.csv").string()));
    EXPECT_EQ(digest_of(made.store), whole_digest(made));
}

} // namespace
} // namespace macadam::testing
