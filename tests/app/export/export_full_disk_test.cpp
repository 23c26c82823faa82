// What `macadam export` leaves of a file that GDAL could not finish.

#include "support/program/places.hpp"
#include "support/program/program.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

namespace macadam {
namespace {

using testing::fresh_folder;
using ::testing::HasSubstr;
using testing::run_macadam;

/// The size of the largest file in a folder.
std::size_t largest_in(const std::filesystem::path& folder) {
    std::size_t bytes = 0;
    for (const auto& entry : std::filesystem::directory_iterator{folder}) {
        bytes = std::max<std::size_t>(bytes, entry.file_size());
    }
    return bytes;
}

TEST(ExportOnAFullDisk, LeavesNothingOfAnyKind) {
    const auto folder = fresh_folder();
    const auto store = (folder / "roads.gpkg").string();
    const auto rav4 = testing::source_folder() + "/sample_data/comma2k19/comma2k19_rav4.trip.csv";
    ASSERT_EQ(run_macadam({"init", store, "--trace", rav4}).exit_status, 0);
    const auto out = folder / "out";
    for (const auto* name : {"roads.fgb", "roads.shp", "roads.kml", "roads.xlsx"}) {
        std::filesystem::create_directory(out);
        const auto file = (out / name).string();
        ASSERT_EQ(run_macadam({"export", store, "--all", "-o", file}).exit_status, 0);
        const auto whole = largest_in(out);
        std::filesystem::remove_all(out);
        std::filesystem::create_directory(out);

        for (const auto max_bytes : {whole / 10, whole / 3, whole / 2, whole - 1}) {
            const auto run = run_macadam({"export", store, "--all", "-o", file}, max_bytes);
            EXPECT_EQ(run.exit_status, 1) << name << max_bytes;
            EXPECT_THAT(run.err, HasSubstr(std::string{name} + ": cannot be written")) << max_bytes;
            EXPECT_TRUE(std::filesystem::is_empty(out)) << name << max_bytes;
        }
        std::filesystem::remove_all(out);
    }
}

} // namespace
} // namespace macadam
