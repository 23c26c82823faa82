// What `macadam convert` does with real logs, as users run it.

#include "estimator/common/trip.hpp"
#include "storage/trips/trip_reader.hpp"
#include "support/program/places.hpp"
#include "support/program/program.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <csignal>
#include <filesystem>

namespace macadam {
namespace {

using ::testing::EndsWith;
using testing::fresh_folder;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::read_file;
using testing::run_macadam;
using testing::write_file;

const std::string rav4 =
    testing::source_folder() + "/sample_data/comma2k19/comma2k19_rav4.trip.csv";
const std::string rtk = testing::source_folder() + "/tests/data/rawlog/test_rtk_path.rawlog";

const std::string tiny = "# macadam-trip 1\n# trip_id: tiny\n"
                         "t_s,acc_z_mps2,speed_mps\n0,9.8,\n0.01,9.9,12.5\nx,9.9,12.5\n"
                         "# end rows: 3\n";

TEST(Convert, MakesALogOfARawlogOfALog) {
    const auto folder = fresh_folder();
    const auto rawlog = (folder / "a.rawlog").string();
    const auto log = (folder / "a.trip.csv.gz").string();
    ASSERT_EQ(run_macadam({"convert", rav4, "-o", rawlog}).exit_status, 0);
    const auto run = run_macadam({"convert", rawlog, "-o", log});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    EXPECT_THAT(run.out, IsEmpty());

    const auto before = run_macadam({"trace", rav4, "--method", "kf"});
    const auto after = run_macadam({"trace", log, "--method", "kf"});
    EXPECT_EQ(before.exit_status, 0) << before.err;
    EXPECT_EQ(before.out, after.out);
}

TEST(Convert, AccountsForTheRows) {
    const auto folder = fresh_folder();
    write_file(folder / "tiny.trip.csv", tiny);
    const auto output = (folder / "out.trip.csv").string();
    const auto run = run_macadam({"convert", (folder / "tiny.trip.csv").string(), "-o", output});
    EXPECT_EQ(run.exit_status, 0);
    EXPECT_THAT(run.err,
                HasSubstr("out.trip.csv: 3 rows read, 2 rows written; skipped: 1 bad_number\n"));
    EXPECT_EQ(read_file(output),
              "# macadam-trip 1\n# trip_id: tiny\n# t0_utc: unknown\n# gravity: included\n"
              "t_s,acc_z_mps2,speed_mps\n0.000000,9.80000,\n0.010000,9.90000,12.5000\n"
              "# end rows: 2\n");
}

TEST(Convert, PutsSeveralTripsIntoAFolder) {
    const auto folder = fresh_folder();
    write_file(folder / "tiny.trip.csv", tiny);
    const auto output = folder / "new" / "logs";
    const auto run = run_macadam({"convert",
                                  (folder / "tiny.trip.csv").string(),
                                  rtk,
                                  "-o",
                                  output.string(),
                                  "--format",
                                  ".trip.csv.zst"});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_EQ(read_trip({output / "tiny.trip.csv.zst", ""}, {}).rows.size(), 2U);
    EXPECT_EQ(read_trip({output / "test_rtk_path.trip.csv.zst", ""}, {}).meta.t0_utc_s,
              read_trip({rtk, ""}, {}).meta.t0_utc_s);
}

TEST(Convert, GoesOnAfterATripThatCannotBeRead) {
    const auto folder = fresh_folder();
    write_file(folder / "bad.trip.csv", "bumps\n");
    write_file(folder / "tiny.trip.csv", tiny);
    const auto output = folder / "out";
    const auto run = run_macadam({"convert", folder.string(), "-o", output.string()});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("bad.trip.csv:1: 'bumps', expected '# macadam-trip 1'"));
    EXPECT_THAT(run.err, HasSubstr("1 of 2 trips could not be converted; the others are in"));
    EXPECT_TRUE(std::filesystem::exists(output / "tiny.trip.csv.gz"));
    EXPECT_FALSE(std::filesystem::exists(output / "bad.trip.csv.gz"));
}

TEST(Convert, SpeaksOfNoOthersWhereNoneCouldBeConverted) {
    const auto folder = fresh_folder();
    write_file(folder / "bad.trip.csv", "bumps\n");
    write_file(folder / "worse.trip.csv", "dents\n");
    const auto run =
        run_macadam({"convert", folder.string(), "-o", (folder / "out").string() + "/"});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("2 of 2 trips could not be converted\n"));
}

TEST(Convert, RefusesToWriteOverWhatItReads) {
    const auto folder = fresh_folder();
    const auto log = (folder / "tiny.trip.csv").string();
    write_file(log, tiny);
    const auto run = run_macadam({"convert", log, "-o", log});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("is also an input, expected another file to write to"));
    EXPECT_EQ(read_file(log), tiny);
}

TEST(Convert, KeepsTheFoldersInWhichTripsLay) {
    const auto folder = fresh_folder();
    for (const auto* day : {"monday", "tuesday"}) {
        std::filesystem::create_directories(folder / "trips" / day);
        write_file(folder / "trips" / day / "00.trip.csv", tiny);
    }
    const auto output = folder / "out";
    const auto run =
        run_macadam({"convert", (folder / "trips").string() + "/", "-o", output.string()});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_TRUE(std::filesystem::exists(output / "monday" / "00.trip.csv.gz"));
    EXPECT_TRUE(std::filesystem::exists(output / "tuesday" / "00.trip.csv.gz"));
}

TEST(Convert, GoesOnAfterAPathThatHoldsNoTrip) {
    const auto folder = fresh_folder();
    write_file(folder / "tiny.trip.csv", tiny);
    write_file(folder / "cut.zip", "PK\x03\x04");
    const auto run = run_macadam({"convert",
                                  (folder / "cut.zip").string(),
                                  (folder / "tiny.trip.csv").string(),
                                  "-o",
                                  (folder / "out").string()});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("cut.zip: the archive is truncated or damaged"));
    EXPECT_THAT(run.err, HasSubstr("1 of 2 trips could not be converted"));
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / "tiny.trip.csv.gz"));
}

TEST(Convert, TakesNoNameForAFolderThatLooksLikeAFile) {
    const auto folder = fresh_folder();
    write_file(folder / "tiny.trip.csv", tiny);
    const auto tiny_file = (folder / "tiny.trip.csv").string();
    const auto run = run_macadam({"convert", tiny_file, "-o", (folder / "drive.csv").string()});
    EXPECT_EQ(run.exit_status, 2);
    EXPECT_THAT(run.err, HasSubstr("drive.csv', expected a name that ends in .trip.csv.gz, "));
    EXPECT_FALSE(std::filesystem::exists(folder / "drive.csv"));
    EXPECT_EQ(
        run_macadam({"convert", tiny_file, "-o", (folder / "v1.2").string() + "/"}).exit_status, 0);
    EXPECT_EQ(run_macadam({"convert", tiny_file, "-o", (folder / "v1.2").string()}).exit_status, 0);
}

/// Whether an unfinished file has a name.
bool holds_a_part(const std::filesystem::path& folder) {
    return std::ranges::any_of(
        std::filesystem::recursive_directory_iterator{folder}, [](const auto& entry) {
            return entry.path().filename().string().find(".part-") != std::string::npos;
        });
}

TEST(Convert, LeavesNoPartOfAFileWhenItIsInterrupted) {
    const auto folder = fresh_folder();
    constexpr int copies = 20; // more than are done before the signal comes
    for (int i = 0; i < copies; ++i) {
        std::filesystem::copy_file(rav4, folder / (std::to_string(i) + ".trip.csv"));
    }
    const auto run = testing::run_macadam_signalled(
        {"convert", folder.string(), "-o", (folder / "out").string(), "--level", "9"},
        [&] { return std::filesystem::exists(folder / "out"); },
        SIGINT);
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("macadam convert: interrupted: "));
    EXPECT_THAT(run.err, HasSubstr(" of 20 trips were not converted"));
    EXPECT_FALSE(holds_a_part(folder));
}

TEST(Convert, RefusesToWriteTwoTripsIntoOneFile) {
    const auto folder = fresh_folder();
    std::filesystem::create_directories(folder / "a");
    std::filesystem::create_directories(folder / "b");
    write_file(folder / "a" / "tiny.trip.csv", tiny);
    write_file(folder / "b" / "tiny.trip.csv", tiny);
    auto run = run_macadam({"convert",
                            (folder / "a").string(),
                            (folder / "b").string(),
                            "-o",
                            (folder / "out").string()});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("tiny.trip.csv.gz: would be written twice, from "));
    EXPECT_THAT(run.err, HasSubstr("1 of 2 trips could not be converted"));
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / "tiny.trip.csv.gz"));
    std::filesystem::remove_all(folder / "out");
    run = run_macadam({"convert", folder.string(), "-o", (folder / "x.rawlog").string()});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("x.rawlog: is one file, expected a folder for 2 trips"));
}

TEST(Convert, LeavesNothingOfAFileThatDoesNotFit) {
    const auto folder = fresh_folder();
    for (const std::string name : {"a.trip.csv", "a.rawlog"}) {
        const auto run = run_macadam({"convert", rav4, "-o", (folder / name).string()}, 20000);
        EXPECT_EQ(run.exit_status, 1);
        EXPECT_THAT(run.err, HasSubstr(name + ": cannot be written: File too large"));
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(Convert, ExplainsItsOptions) {
    EXPECT_EQ(run_macadam({"convert", rav4}).exit_status, 2);
    const auto run = run_macadam({"convert", rav4, "-o", "x", "--format", ".doc"});
    EXPECT_EQ(run.exit_status, 2);
    EXPECT_THAT(run.err, HasSubstr("'.doc'"));
    EXPECT_EQ(run_macadam({"convert", rav4, "-o", "x", "--level", "0"}).exit_status, 2);
}

TEST(Convert, LetsARawlogBeMatchedAndTraced) {
    const auto folder = fresh_folder();
    const auto store = (folder / "roads.gpkg").string();
    const auto rawlog = (folder / "a.rawlog").string();
    ASSERT_EQ(run_macadam({"convert", rav4, "-o", rawlog}).exit_status, 0);
    ASSERT_EQ(run_macadam({"init", store, "--trace", rawlog}).exit_status, 0);
    EXPECT_EQ(run_macadam({"match", rawlog, "--network", store}).out,
              run_macadam({"match", rav4, "--network", store}).out);
    const auto run = run_macadam({"import", store, rawlog, "--json", "--method", "kf"});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr(R"("result":"imported")"));
}

} // namespace
} // namespace macadam
