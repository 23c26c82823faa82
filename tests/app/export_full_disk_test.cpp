// What `macadam export` leaves of a file that GDAL could not finish.

#include "support/program.hpp"

#include <gmock/gmock.h>

#include <filesystem>

namespace macadam {
namespace {

using testing::fresh_folder;
using ::testing::HasSubstr;
using testing::run_macadam;

TEST(ExportOnAFullDisk, LeavesNothingOfAFlatGeobuf) {
    const auto folder = fresh_folder();
    const auto store = (folder / "roads.gpkg").string();
    const auto rav4 =
        std::string{MACADAM_SOURCE_DIR} + "/sample_data/comma2k19/comma2k19_rav4.trip.csv";
    ASSERT_EQ(run_macadam({"init", store, "--trace", rav4}).exit_status, 0);
    const auto out = folder / "out";
    std::filesystem::create_directory(out);
    const auto file = (out / "roads.fgb").string();
    ASSERT_EQ(run_macadam({"export", store, "--all", "-o", file}).exit_status, 0);
    const auto whole = std::filesystem::file_size(file);
    std::filesystem::remove(file);

    for (const auto most_bytes : {whole / 10, whole / 3, whole / 2, whole - 1}) {
        const auto run = run_macadam({"export", store, "--all", "-o", file}, most_bytes);
        EXPECT_EQ(run.exit_status, 1) << most_bytes;
        EXPECT_THAT(run.err, HasSubstr("roads.fgb: cannot be written")) << most_bytes;
        EXPECT_THAT(run.err, HasSubstr("the disk may be full")) << most_bytes;
        EXPECT_TRUE(std::filesystem::is_empty(out)) << most_bytes;
    }
}

} // namespace
} // namespace macadam
