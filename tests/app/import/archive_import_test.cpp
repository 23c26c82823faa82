// Trips that come in archives, through the commands that read trips.

#include "support/files/compressed.hpp"
#include "support/program/program.hpp"
#include "support/roads/drive.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <sstream>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string log_of(double length_m) {
    const Drive drive{.length_m = length_m};
    return text_of(drive_over(patched_road([](double) { return false; }, 1),
                              drive,
                              *built_in_vehicle("golden-car")),
                   drive);
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream{text};
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

struct World {
    fs::path folder;
    std::string store;
};

World world() {
    World made{fresh_folder(), {}};
    made.store = (made.folder / "roads.gpkg").string();
    write_file(made.folder / "road.trip.csv", log_of(1200));
    EXPECT_EQ(run_macadam({"init", made.store, "--trace", (made.folder / "road.trip.csv").string()})
                  .exit_status,
              0);
    return made;
}

std::string archive_in(const World& made,
                       const std::string& format,
                       const std::vector<std::pair<std::string, std::string>>& members) {
    const auto file = made.folder / ("fleet." + format);
    write_file(file, archive_of(format, members));
    return file.string();
}

TEST(ArchiveImport, TellsOfTripsInTheirOrderAndTwoOfOneNameAreTwo) {
    const auto made = world();
    const std::vector<std::pair<std::string, std::string>> members{{"z/a.trip.csv", log_of(1000)},
                                                                   {"b.trip.csv", "bumps\n"},
                                                                   {"z/a.trip.csv", log_of(1100)},
                                                                   {"notes.txt", "x"},
                                                                   {"c.trip.csv", log_of(1000)}};
    for (const std::string format : {"zip", "tar.gz"}) {
        const auto archive = archive_in(made, format, members);
        const auto run =
            run_macadam({"import", made.store, archive, "--method", "kf", "--jobs", "2", "--json"});
        EXPECT_EQ(run.exit_status, 1);
        const auto first = format == "zip" ? "\"result\":\"imported\"" : "\"result\":\"known\"";
        EXPECT_THAT(lines_of(run.out),
                    ElementsAre(AllOf(HasSubstr("z/a.trip.csv"), HasSubstr(first)),
                                AllOf(HasSubstr("b.trip.csv"), HasSubstr("rejected")),
                                AllOf(HasSubstr("z/a.trip.csv"), HasSubstr(first)),
                                AllOf(HasSubstr("c.trip.csv"), HasSubstr("known"))))
            << run.err;
        EXPECT_THAT(run.err, HasSubstr("1 file ignored: notes.txt"));
        EXPECT_THAT(run.err, HasSubstr("1 of 4 trips rejected; the others are in the database"));
    }
    const auto again = run_macadam(
        {"reprocess", made.store, (made.folder / "fleet.tar.gz").string(), "--method", "kf"});
    EXPECT_THAT(again.err, HasSubstr("reprocessed")) << again.out;
}

TEST(ArchiveImport, HoldsToTheLimitOfFilesThatIsAskedFor) {
    const auto made = world();
    const auto archive =
        archive_in(made, "tar.gz", {{"a.trip.csv", log_of(1000)}, {"b.trip.csv", log_of(1100)}});
    const auto few = run_macadam(
        {"import", made.store, archive, "--method", "kf", "--max-members", "1", "--json"});
    EXPECT_EQ(few.exit_status, 1);
    EXPECT_THAT(lines_of(few.out),
                ElementsAre(HasSubstr("imported"),
                            HasSubstr("fleet.tar.gz: contains more than 1 files; --max-members "
                                      "N raises the limit")));
    const auto all =
        run_macadam({"import", made.store, archive, "--method", "kf", "--max-members", "2"});
    EXPECT_EQ(all.exit_status, 0) << all.err;
    EXPECT_EQ(run_macadam({"import", made.store, archive, "--max-members", "0"}).exit_status, 2);
}

TEST(ArchiveImport, IsToldWhereAnArchiveHoldsNone) {
    const auto made = world();
    const auto run =
        run_macadam({"import", made.store, archive_in(made, "zip", {{"notes.txt", "x"}})});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("fleet.zip: contains no trip log"));
}

TEST(ArchiveImport, IsWhatConvertAndTraceRead) {
    const auto made = world();
    const auto archive =
        archive_in(made, "zip", {{"../x.trip.csv", log_of(1000)}, {"y.trip.csv", log_of(1100)}});
    const auto out = made.folder / "out";
    const auto run = run_macadam({"convert", archive, "-o", out.string() + "/"});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_FALSE(fs::exists(made.folder / "x.trip.csv.gz"));
    EXPECT_EQ(std::distance(fs::recursive_directory_iterator{out}, {}), 2);
    EXPECT_THAT(run_macadam({"convert", archive, "-o", (made.folder / "x.rawlog").string()}).err,
                HasSubstr("x.rawlog: is one file, expected a folder for 2 trips"));
    EXPECT_THAT(run_macadam({"trace", archive}).err,
                HasSubstr("fleet.zip: contains 2 trip logs, expected one"));
}

} // namespace
} // namespace macadam::testing
