#include "storage/profiles/erd_writer.hpp"

#include "storage/profiles/profile_reader.hpp"
#include "support/files/files.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>

using namespace macadam;
using namespace macadam::testing;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

namespace {

ErdProfile two_tracks(std::size_t points) {
    std::mt19937 random{5};
    std::normal_distribution<double> step_m{0, 0.002};
    ErdProfile profile{.title = "Test", .start_m = 478.5, .step_m = 0.05, .channels = {}};
    for (const char* const name : {"left", "right"}) {
        profile.channels.push_back({name, {}});
        double z_m = 583;
        for (std::size_t i = 0; i < points; ++i) {
            profile.channels.back().elevation_m.push_back(z_m += step_m(random));
        }
    }
    return profile;
}

std::string text_of(const std::filesystem::path& file) {
    std::ifstream in{file};
    return {std::istreambuf_iterator<char>{in}, {}};
}

} // namespace

TEST(ErdWriter, GivesBackWhatItPrints) {
    const auto profile = two_tracks(20'000);
    const auto file = test_folder() / "a.erd";
    write_erd(file, profile);
    const auto again = read_profile(file, {});
    ASSERT_EQ(again.tracks.size(), 2U);
    EXPECT_EQ(again.tracks[0].name, "left");
    EXPECT_EQ(again.tracks[1].name, "right");
    EXPECT_EQ(again.even_step_m, 0.05);
    EXPECT_EQ(again.station_m.front(), 478.5);
    for (std::size_t track = 0; track < 2; ++track) {
        ASSERT_EQ(again.tracks[track].elevation_m.size(), 20'000U);
        for (std::size_t i = 0; i < 20'000; ++i) {
            // Four decimals of a millimetre.
            const double printed_m = std::round(profile.channels[track].elevation_m[i] * 1e7) / 1e7;
            ASSERT_NEAR(again.tracks[track].elevation_m[i], printed_m, 1e-12) << i;
        }
    }
}

TEST(ErdWriter, WritesTheSameTextAgainFromWhatWasRead) {
    const auto folder = test_folder();
    auto profile = two_tracks(500);
    write_erd(folder / "a.erd", profile);
    const auto read = read_profile(folder / "a.erd", {});
    for (std::size_t i = 0; i < 2; ++i) {
        profile.channels[i].elevation_m = read.tracks[i].elevation_m;
    }
    write_erd(folder / "b.erd", profile);
    EXPECT_EQ(text_of(folder / "a.erd"), text_of(folder / "b.erd"));
}

/// Columns as the specification has them: eight for a keyword, eight for each name and unit.
TEST(ErdWriter, WritesTheHeadOfTheSpecification) {
    const auto file = test_folder() / "a.erd";
    write_erd(file,
              {.title = "one\nline",
               .start_m = 0,
               .step_m = 0.1,
               .channels = {{"left", {0.001, -0.002}}, {"centre line", {0, 1}}}});
    EXPECT_EQ(text_of(file),
              "ERDFILEV2.00\n"
              "2, 2, -1, 1, 5, 0.1, -1\n"
              "TITLE   one line\n"
              "SHORTNAMLElev.  centre l\n"
              "UNITSNAMmm      mm      \n"
              "XLABEL  Distance\n"
              "XUNITS  m\n"
              "FORMAT  (2F15.4)\n"
              "END\n"
              "         1.0000         0.0000\n"
              "        -2.0000      1000.0000\n");
}

TEST(ErdWriter, WritesRemarksThatReadersPassOver) {
    const auto file = test_folder() / "a.erd";
    auto profile = two_tracks(20);
    profile.remarks = {"one\nline", "END of no header"};
    write_erd(file, profile);
    EXPECT_THAT(text_of(file), HasSubstr("HISTORY one line\nHISTORY END of no header\n"));
    EXPECT_EQ(read_profile(file, {}).tracks[0].elevation_m.size(), 20U);
}

TEST(ErdWriter, LeavesNoFileOfElevationsThatAreNone) {
    const auto file = test_folder() / "a.erd";
    auto profile = two_tracks(10);
    profile.channels[1].elevation_m[3] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT(refusal_of([&] { write_erd(file, profile); }),
                EndsWith("a.erd: elevation 4 of right is 'nan', expected at most 10000 m"));
    EXPECT_FALSE(std::filesystem::exists(file));
}
