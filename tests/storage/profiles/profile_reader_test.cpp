#include "storage/profiles/profile_reader.hpp"

#include "support/files/files.hpp"

#include <gmock/gmock.h>

using namespace macadam;
using namespace macadam::testing;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;

namespace {

MeasuredProfile
read_text(const std::string& name, const std::string& text, std::optional<double> step_m = {}) {
    return read_profile(written(test_folder(), name, text), step_m);
}

std::string refusal_of_text(const std::string& name,
                            const std::string& text,
                            std::optional<double> step_m = {}) {
    return refusal_of([&] { read_text(name, text, step_m); });
}

} // namespace

TEST(ProfileReader, ReadsTheTracksOfACsv) {
    const auto profile =
        read_text("a.csv", "station_m,left_m,right_m\n10,0.1,0.2\n10.25,-1e-3,+0.5\n\n10.5,0,0\n");
    EXPECT_THAT(profile.station_m, ElementsAre(10, 10.25, 10.5));
    ASSERT_EQ(profile.tracks.size(), 2U);
    EXPECT_EQ(profile.tracks[0].name, "left");
    EXPECT_EQ(profile.tracks[1].name, "right");
    EXPECT_THAT(profile.tracks[0].elevation_m, ElementsAre(0.1, -0.001, 0));
    EXPECT_EQ(profile.even_step_m, 0.25);
}

TEST(ProfileReader, ReadsTextWithBlanksBetween) {
    const auto profile =
        read_text("a.txt", "478.0000 583.1370\r\n 478.1557\t583.1349\r\n478.5836 583.1285\r\n");
    EXPECT_THAT(profile.station_m, ElementsAre(478, 478.1557, 478.5836));
    ASSERT_EQ(profile.tracks.size(), 1U);
    EXPECT_EQ(profile.tracks[0].name, "profile");
    EXPECT_FALSE(profile.even_step_m);
}

TEST(ProfileReader, NamesTwoColumnsWithoutAHeaderLeftAndRight) {
    const auto profile = read_text("a.txt", "1 2\n3 4\n", 0.1);
    EXPECT_THAT(profile.station_m, ElementsAre(0, 0.1));
    EXPECT_EQ(profile.tracks[0].name, "left");
    EXPECT_THAT(profile.tracks[1].elevation_m, ElementsAre(2, 4));
    EXPECT_EQ(profile.even_step_m, 0.1);
}

TEST(ProfileReader, TakesStationsForEvenWithinAThousandthOfTheirStep) {
    EXPECT_TRUE(read_text("a.txt", "0 1\n0.2501 1\n0.5 1\n").even_step_m);
    EXPECT_FALSE(read_text("a.txt", "0 1\n0.2504 1\n0.5 1\n").even_step_m);
}

TEST(ProfileReader, AsksForStationsOrAStep) {
    EXPECT_THAT(
        refusal_of_text("a.csv", "left_m\n0\n1\n"),
        EndsWith("a.csv:1: the first column is 'left_m', expected 'station_m', or the option "
                 "--step for elevations at even steps"));
    EXPECT_THAT(refusal_of_text("a.txt", "0\n1\n"), HasSubstr("or the option --step"));
    EXPECT_THAT(refusal_of_text("a.csv", "station_m,left_m\n0,1\n1,1\n", 0.25),
                EndsWith("a.csv:1: the header has 'station_m', expected only elevations with "
                         "the option --step"));
    EXPECT_EQ(read_text("a.csv", "left_m\n0\n1\n", 0.25).tracks.at(0).name, "left");
}

TEST(ProfileReader, SaysWhichLineIsWrong) {
    EXPECT_THAT(refusal_of_text("a.csv", "station_m,left_m\n0,1\n1,bump\n"),
                EndsWith("a.csv:3: 'bump', expected one elevation in metres"));
    EXPECT_THAT(refusal_of_text("a.csv", "station_m,left_m\n0,1\nx,1\n"),
                EndsWith("a.csv:3: 'x', expected one station in metres"));
    EXPECT_THAT(refusal_of_text("a.csv", "station_m,left_m\n0,1\n1,\n"),
                EndsWith("a.csv:3: '', expected one elevation in metres"));
    EXPECT_THAT(refusal_of_text("a.txt", "0 1\n1 nan\n"),
                EndsWith("a.txt:2: 'nan', expected one elevation in metres"));
    EXPECT_THAT(refusal_of_text("a.txt", "0 1\n1 2 3\n"),
                EndsWith("a.txt:2: '1 2 3' has 3 cells, expected 2"));
    EXPECT_THAT(refusal_of_text("a.txt", "0 1\n1 2\n1 3\n"),
                EndsWith("a.txt:3: station '1', expected more than the previous one, 1"));
}

TEST(ProfileReader, RefusesAHeaderThatIsNone) {
    EXPECT_THAT(refusal_of_text("a.csv", "0,1\n1,2\n"),
                EndsWith("a.csv:1: '0,1', expected a header with a name for each column"));
    EXPECT_THAT(refusal_of_text("a.csv", "station_m,left_m,left_m\n"),
                EndsWith("a.csv:1: column 'left_m' occurs twice, expected once"));
}

TEST(ProfileReader, RefusesWhatIsNoProfile) {
    EXPECT_THAT(refusal_of_text("a.txt", "0 1\n"),
                EndsWith("has 1 rows of numbers, expected at least two"));
    EXPECT_THAT(refusal_of_text("a.txt", ""), HasSubstr("has 0 rows"));
    EXPECT_THAT(refusal_of_text("a.ppf", "0 1\n1 1\n"),
                EndsWith("a.ppf: ends in '.ppf', expected a profile in .csv, .txt, .erd or .pro"));
    EXPECT_THAT(refusal_of_text("a.txt", "1\n2\n", 0.0), HasSubstr("expected metres above 0"));
}
