#include "storage/profiles/profile_reader.hpp"

#include "support/files/files.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <utility>

using namespace macadam;
using namespace macadam::testing;
using ::testing::EndsWith;
using ::testing::Pointwise;

namespace {

const std::string head = "HEAD3,03-11-2014,14,227,SH0130,0434,K1\n"
                         "CMET3,Profiler 7,A,Operator,12345,200,0417,04-17-2013\n"
                         "Maker,mils,both,3.0,in\n"
                         "30.1,-97.6,150.0,180.0,60.0\n"
                         "a comment, with a comma\n";

MeasuredProfile read_text(const std::string& text,
                          std::optional<double> step_m = {},
                          const std::string& name = "a.pro") {
    return read_profile(written(test_folder(), name, text), step_m);
}

std::string refusal_of_text(const std::string& text) {
    return refusal_of([&] { read_text(text); });
}

MATCHER(IsNear, "") {
    return std::abs(std::get<0>(arg) - std::get<1>(arg)) < 1e-12;
}

} // namespace

TEST(ProProfile, ReadsTwoPathsInMils) {
    const auto profile = read_text(head + "100,-200,\n101.5,-201,bridge\n0,0,\n", {}, "A.PRO");
    ASSERT_EQ(profile.tracks.size(), 2U);
    EXPECT_EQ(profile.tracks[0].name, "left");
    EXPECT_EQ(profile.tracks[1].name, "right");
    EXPECT_THAT(profile.station_m, Pointwise(IsNear(), {0.0, 0.0762, 0.1524}));
    EXPECT_THAT(profile.tracks[0].elevation_m, Pointwise(IsNear(), {2.54e-3, 2.5781e-3, 0.0}));
    EXPECT_THAT(profile.tracks[1].elevation_m, Pointwise(IsNear(), {-5.08e-3, -5.1054e-3, 0.0}));
}

TEST(ProProfile, LeavesPositionsOut) {
    const auto profile =
        read_text(head + "1,2,,30.1,-97.6,150,180,60\n3,4,,30.1,-97.6,150,180,60\n");
    ASSERT_EQ(profile.tracks.size(), 2U);
    EXPECT_THAT(profile.tracks[1].elevation_m, Pointwise(IsNear(), {2 * 2.54e-5, 4 * 2.54e-5}));
}

TEST(ProProfile, ReadsOnePath) {
    auto right = head;
    right.replace(right.find("both"), 4, "RIGHT");
    const auto profile = read_text(right + "100,\n200,\n");
    ASSERT_EQ(profile.tracks.size(), 1U);
    EXPECT_EQ(profile.tracks[0].name, "right");
    EXPECT_EQ(read_text(right + "1,,30.1,-97.6,150,180,60\n2,,1,1,1,1,1\n").tracks.size(), 1U);
}

TEST(ProProfile, ReadsTwoPathsWithoutComments) {
    const auto profile = read_text(head + "1,2\n3,4\n\x1a");
    ASSERT_EQ(profile.tracks.size(), 2U);
    EXPECT_NEAR(profile.tracks[1].elevation_m[1], 4 * 2.54e-5, 1e-15);
}

TEST(ProProfile, ReadsOtherUnitsAndAnotherStep) {
    auto metric = head;
    metric.replace(metric.find("mils,both,3.0,in"), 16, "mm,both,25,mm");
    EXPECT_THAT(read_text(metric + "1,2,\n3,4,\n").station_m, Pointwise(IsNear(), {0.0, 0.025}));
    EXPECT_NEAR(read_text(metric + "1,2,\n3,4,\n").tracks[0].elevation_m[1], 0.003, 1e-15);
    EXPECT_EQ(read_text(head + "1,2,\n3,4,\n", 0.1).even_step_m, 0.1);
}

TEST(ProProfile, SaysWhatIsWrong) {
    EXPECT_THAT(refusal_of_text("HEAD1,a\n"),
                EndsWith("a.pro:1: 'HEAD1,a', expected a record 'HEAD3'"));
    EXPECT_THAT(refusal_of_text("HEAD3,a\nx\n"),
                EndsWith("a.pro:2: 'x', expected a record 'CMET3'"));
    EXPECT_THAT(refusal_of_text("HEAD3\nCMET3\nMaker,volts,both,3,in\n"),
                EndsWith("a.pro:3: 'Maker,volts,both,3,in', expected maker, unit of elevation, "
                         "wheel path, distance between points and its unit (m, cm, mm, um, ft, in "
                         "or mil)"));
    EXPECT_THAT(refusal_of_text(head),
                EndsWith("a.pro: has no points after its five header "
                         "lines"));
    EXPECT_THAT(refusal_of_text(head + "1,2,\n1,bump,\n"),
                EndsWith("a.pro:7: '1,bump,', expected two elevations at its beginning"));
    auto unstated = head;
    unstated.replace(unstated.find("both"), 4, "");
    EXPECT_THAT(refusal_of_text(unstated + "1,2,3,4\n"),
                EndsWith("a.pro:6: '1,2,3,4' has 4 cells, expected 2 or 3 (one or two elevations "
                         "and a comment), or five more with a position; or a wheel path 'L', 'R' "
                         "or 'LR' in line 3"));
    EXPECT_THAT(refusal_of_text(head + "1,bridge\n"),
                EndsWith("a.pro:6: '1,bridge', expected two elevations at its beginning"));
}

TEST(ProProfile, ReadsAbbreviatedUnitsAndPathsOfProfilers) {
    const struct {
        const char* units;
        double step_m;
    } cases[] = {{"Dynatest,mil,LR,3,i", 0.0762},
                 {"Dynatest,mil,LR,0.25,f", 0.0762},
                 {"ICC,mils,B,0.0762,m", 0.0762},
                 {"SSI,mil,L&R,3,I", 0.0762}};
    for (const auto& [units, step_m] : cases) {
        auto other = head;
        other.replace(other.find("Maker,mils,both,3.0,in"), 22, units);
        const auto profile = read_text(other + "1,2\n3,4\n");
        ASSERT_EQ(profile.tracks.size(), 2U) << units;
        EXPECT_NEAR(profile.station_m[1], step_m, 1e-12) << units;
        EXPECT_NEAR(profile.tracks[1].elevation_m[1], 4 * 2.54e-5, 1e-15) << units;
    }
}

TEST(ProProfile, ReadsPositionsInAnyNumberOfColumnsWhereThePathIsStated) {
    for (const char* const fix : {",30.1,-97.6", ",,30.1,-97.6", ",bridge,30.1,-97.6,150"}) {
        const auto profile = read_text(head + "1,2" + fix + "\n" + "3,4" + fix + "\n");
        ASSERT_EQ(profile.tracks.size(), 2U) << fix;
        EXPECT_NEAR(profile.tracks[1].elevation_m[1], 4 * 2.54e-5, 1e-15) << fix;
    }
    auto left = head;
    left.replace(left.find("both"), 4, "L");
    EXPECT_EQ(read_text(left + "1,30.1,-97.6\n2,30.1,-97.6\n").tracks.size(), 1U);
}

TEST(ProProfile, LeavesLinesOfCommentOut) {
    const auto profile = read_text(head + "operator: second run\nwet, cold\n1,2,\n# joint\n"
                                          "3,4,\n* end of the bridge\n5,6,\n");
    EXPECT_THAT(profile.station_m, Pointwise(IsNear(), {0.0, 0.0762, 0.1524}));
    EXPECT_NEAR(profile.tracks[0].elevation_m[2], 5 * 2.54e-5, 1e-15);
}

TEST(ProProfile, ReadsBothPathsWhereTheirNamesAreSpeltOut) {
    for (const char* const path :
         {"Left & Right", "LEFT AND RIGHT", "LWP/RWP", "right/left", "RL"}) {
        auto other = head;
        other.replace(other.find("both"), 4, path);
        const auto profile = read_text(other + "1,2,\n3,4,\n");
        ASSERT_EQ(profile.tracks.size(), 2U) << path;
        EXPECT_EQ(profile.tracks[0].name, "left") << path;
    }
    for (const auto& [path, name] : {std::pair{"LWP", "left"}, std::pair{"Right WP", "right"}}) {
        auto one = head;
        one.replace(one.find("both"), 4, path);
        const auto profile = read_text(one + "1,\n2,\n");
        ASSERT_EQ(profile.tracks.size(), 1U) << path;
        EXPECT_EQ(profile.tracks[0].name, name) << path;
    }
}

TEST(ProProfile, RefusesAPointThatHasOverflowed) {
    EXPECT_THAT(refusal_of_text(head + "1,2,\n*****,1.2\n3,4,\n"),
                EndsWith("a.pro:7: '*****,1.2', expected two elevations at its beginning"));
    EXPECT_THAT(refusal_of_text(head + "*****,1.2E+01,\n3,4,\n"),
                EndsWith("a.pro:6: '*****,1.2E+01,', expected two elevations at its beginning"));
}
