// The program while it watches a folder.

#include "support/program/piped_program.hpp"
#include "support/program/program.hpp"
#include "support/roads/drive.hpp"

#include <gmock/gmock.h>

#include <csignal>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr auto enough = 60s; // for one line, also on a busy machine

std::string log_named(const std::string& trip_id) {
    const Drive drive{.length_m = 600, .trip_id = trip_id};
    return text_of(drive_over(patched_road([](double) { return false; }, 1),
                              drive,
                              *built_in_vehicle("golden-car")),
                   drive);
}

struct World {
    fs::path folder;
    fs::path incoming;
    std::vector<std::string> words;
};

World world() {
    const auto folder = fresh_folder();
    const auto store = (folder / "roads.gpkg").string();
    const auto incoming = folder / "incoming";
    fs::create_directories(incoming);
    write_file(folder / "road.trip.csv", log_named("road"));
    EXPECT_EQ(
        run_macadam({"init", store, "--trace", (folder / "road.trip.csv").string()}).exit_status,
        0);
    return {folder, incoming, {"watch", store, incoming.string(), "--method", "kf", "--json"}};
}

/// Moves a file into the watched folder that was written an hour ago.
void move_in(const World& made, const std::string& name, const std::string& text) {
    write_file(made.folder / name, text);
    fs::last_write_time(made.folder / name, fs::file_time_type::clock::now() - 1h);
    fs::rename(made.folder / name, made.incoming / name);
}

TEST(Watch, ImportsWhatIsThereAndWhatAppearsUntilItIsStopped) {
    const auto made = world();
    move_in(made, "a.trip.csv.gz", "no log");
    move_in(made, "b.trip.csv", log_named("b"));
    PipedProgram watch{made.words};
    EXPECT_THAT(watch.line(enough).value_or(""),
                AllOf(HasSubstr("a.trip.csv.gz"), HasSubstr("\"rejected\"")));
    EXPECT_THAT(watch.line(enough).value_or(""), HasSubstr("\"imported\""));
    move_in(made, "c.trip.csv", log_named("c"));
    EXPECT_THAT(watch.line(enough).value_or(""), // the rejected file is not named again
                AllOf(HasSubstr("c.trip.csv"), HasSubstr("\"imported\"")));
    watch.signal(SIGTERM);
    const auto end = watch.wait();
    EXPECT_EQ(end.exit_status, 0) << end.err;
    EXPECT_THAT(end.err, AllOf(HasSubstr("watching "), HasSubstr("stopped; ")));
}

TEST(Watch, ContinuesAfterARestartWithoutNamingWhatIsKnown) {
    const auto made = world();
    move_in(made, "a.trip.csv", log_named("a"));
    for (const bool again : {false, true}) {
        PipedProgram watch{made.words};
        if (again) {
            move_in(made, "b.trip.csv", log_named("b"));
        }
        EXPECT_THAT(watch.line(enough).value_or(""),
                    HasSubstr(again ? "b.trip.csv" : "a.trip.csv"));
        watch.signal(SIGINT);
        EXPECT_EQ(watch.wait().exit_status, 0);
    }
}

TEST(Watch, EndsWhenItsFolderIsGone) {
    const auto made = world();
    move_in(made, "a.trip.csv", log_named("a"));
    PipedProgram watch{made.words};
    EXPECT_THAT(watch.line(enough).value_or(""), HasSubstr("\"imported\""));
    fs::rename(made.incoming, made.folder / "elsewhere");
    const auto end = watch.wait();
    EXPECT_EQ(end.exit_status, 1);
    EXPECT_THAT(end.err, HasSubstr("incoming: the watched folder is gone: moved, removed, or "));
}

TEST(Watch, RefusesWhatIsNoFolder) {
    const auto made = world();
    const auto run = run_macadam(
        {"watch", (made.folder / "roads.gpkg").string(), (made.folder / "road.trip.csv").string()});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("road.trip.csv: is not a folder, expected the folder"));
}

} // namespace
} // namespace macadam::testing
