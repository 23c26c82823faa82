#include "storage/profiles/profile_reader.hpp"

#include "support/files/files.hpp"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <cstdint>

using namespace macadam;
using namespace macadam::testing;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Pointwise;

namespace {

/// A file of a second line, further head lines, and numbers.
std::string erd(const std::string& layout, const std::string& keywords, const std::string& data) {
    return "ERDFILEV2.00\n" + layout + "\n" + keywords + "END\n" + data;
}

MeasuredProfile read_text(const std::string& text, std::optional<double> step_m = {}) {
    return read_profile(written(test_folder(), "a.erd", text), step_m);
}

std::string refusal_of_text(const std::string& text) {
    return refusal_of([&] { read_text(text); });
}

std::vector<std::string> names_of(const MeasuredProfile& profile) {
    std::vector<std::string> names;
    for (const auto& track : profile.tracks) {
        names.push_back(track.name);
    }
    return names;
}

MATCHER(IsNear, "") {
    return std::abs(std::get<0>(arg) - std::get<1>(arg)) < 1e-12;
}

std::string little_endian(std::uint32_t bits, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) {
        text += static_cast<char>(bits >> (8 * i) & 0xff);
    }
    return text;
}

MeasuredProfile read_binary(const std::string& header, const std::string& numbers) {
    const auto folder = test_folder();
    written(folder, "a.bin", numbers);
    return read_profile(written(folder, "a.erd", header), {});
}

} // namespace

TEST(ErdProfile, ReadsNamesUnitsAndStepOfTwoTracks) {
    const auto profile = read_text(erd("2, 3, -1, 1, 5, 0.5, -1,",
                                       "TITLE   Test section 1\n"
                                       "SHORTNAMLElev.  RElev.  \n"
                                       "UNITSNAMin      in\n"
                                       "XLABEL  Distance\n"
                                       "XUNITS  ft\n",
                                       " 1.0  2.0\n-1.5, 0.25\n 0 1E-1\n"));
    EXPECT_THAT(names_of(profile), ElementsAre("left", "right"));
    // 0.5 ft and inches, exactly.
    EXPECT_THAT(profile.station_m, Pointwise(IsNear(), {0.0, 0.1524, 0.3048}));
    EXPECT_DOUBLE_EQ(profile.even_step_m.value(), 0.1524);
    EXPECT_THAT(profile.tracks[0].elevation_m, Pointwise(IsNear(), {0.0254, -0.0381, 0.0}));
    EXPECT_THAT(profile.tracks[1].elevation_m, Pointwise(IsNear(), {0.0508, 0.00635, 0.00254}));
}

TEST(ErdProfile, KnowsEveryUnitOfLength) {
    const struct {
        const char* unit;
        double metres;
    } cases[] = {{"m", 1},
                 {"M", 1},
                 {"mm", 1e-3},
                 {"cm", 1e-2},
                 {"um", 1e-6},
                 {"microns", 1e-6},
                 {"millimet", 1e-3}, // cut off by the field
                 {"ft", 0.3048},
                 {"FT", 0.3048},
                 {"Feet", 0.3048},
                 {"in", 0.0254},
                 {"in.", 0.0254},
                 {"inches", 0.0254},
                 {"mil", 2.54e-5},
                 {"mils", 2.54e-5}};
    for (const auto& [unit, metres] : cases) {
        const auto profile = read_text(
            erd("1, 2, -1, 1, 5, 0.1", std::string{"UNITSNAM"} + unit + "\nXUNITS  m\n", "2\n4\n"));
        EXPECT_NEAR(profile.tracks[0].elevation_m[1], 4 * metres, 1e-15) << unit;
    }
}

TEST(ErdProfile, LeavesOutWhatIsNoElevation) {
    const auto profile = read_text(erd("5 2 -1 1 5 0.1 -1",
                                       "SHORTNAMStation LElev   Speed   RElev   RutL\n"
                                       "UNITSNAMm       mm      mi/h    mm      mm\n"
                                       "XUNITS  m\n",
                                       "0.0 1 55 3 9\n0.1 2 55 4 9\n"));
    EXPECT_THAT(names_of(profile), ElementsAre("left", "right"));
    EXPECT_THAT(profile.tracks[1].elevation_m, Pointwise(IsNear(), {0.003, 0.004}));
}

TEST(ErdProfile, KeepsNamesThatAreNotOnePair) {
    const auto runs = read_text(erd("4,2,-1,1,5,.1",
                                    "SHORTNAMLElev 1 RElev 1 LElev 2 RElev 2 \n"
                                    "UNITSNAMmm      mm      mm      mm      \nXUNITS  m\n",
                                    "1 2 3 4\n1 2 3 4\n"));
    EXPECT_THAT(names_of(runs), ElementsAre("LElev 1", "RElev 1", "LElev 2", "RElev 2"));
    const auto nameless =
        read_text(erd("2,2,-1,1,5,.1", "UNITSNAMmm      mm\nXUNITS  m\n", "1 2\n1 2\n"));
    EXPECT_THAT(names_of(nameless), ElementsAre("left", "right"));
}

TEST(ErdProfile, TakesNamesOf32CharactersAndLinesThatGoOn) {
    const auto profile = read_text(erd("3,2,-1,1,5,.1",
                                       "LONGNAMELeft elevation                  Right elevation\n"
                                       "&1000   Centre\n"
                                       "UNITSNAMmm      mm\n"
                                       "&1000   in\n"
                                       "XUNITS  m\n",
                                       "1 2 3\n1 2 3\n"));
    EXPECT_THAT(names_of(profile), ElementsAre("left", "right", "Centre"));
    EXPECT_NEAR(profile.tracks[2].elevation_m[0], 3 * 0.0254, 1e-12);
}

TEST(ErdProfile, ReadsSamplesHoweverLinesAreBroken) {
    const std::string head = "UNITSNAMm       m\nXUNITS  m\n";
    for (const char* const data :
         {"1 10\n2 20\n3 30\n", "1 10 2\n20 3\n\n30\n", "1,10,2,20,3,30"}) {
        const auto profile = read_text(erd("2,3,-1,1,5,.1", head, data));
        EXPECT_THAT(profile.tracks[0].elevation_m, ElementsAre(1, 2, 3)) << data;
        EXPECT_THAT(profile.tracks[1].elevation_m, ElementsAre(10, 20, 30)) << data;
    }
}

TEST(ErdProfile, TellsNumbersThatRunTogetherApartByTheFormat) {
    const auto profile = read_text(erd("3,2,-1,1,5,.1",
                                       "UNITSNAMm       m       m\nXUNITS  m\n"
                                       "FORMAT  (1X,3F8.3)\n",
                                       " -100.001-200.002-300.003\n"
                                       "    1.000   2.000   3.000\n"));
    EXPECT_THAT(profile.tracks[0].elevation_m, ElementsAre(-100.001, 1));
    EXPECT_THAT(profile.tracks[2].elevation_m, ElementsAre(-300.003, 3));
}

TEST(ErdProfile, ReadsExponentsOfFortranAndDosLineEnds) {
    const auto profile = read_text("ERDFILEV2.00\r\n1,3,-1,1,5,.1\r\nUNITSNAMm\r\nXUNITS  m\r\n"
                                   "END\r\n0.1D+01\r\n 2.5d-1\r\n3.E0\r\n\x1a");
    EXPECT_THAT(profile.tracks[0].elevation_m, ElementsAre(1, 0.25, 3));
}

TEST(ErdProfile, ReadsAsManySamplesAsThereAreWhereTheHeadDoesNotSay) {
    const std::string head = "UNITSNAMm\nXUNITS  m\n";
    EXPECT_EQ(read_text(erd("1,-1,-1,1,5,.1", head, "1\n2\n3\n")).station_m.size(), 3U);
    // As the program published with the standard: what is over is left.
    EXPECT_EQ(read_text(erd("1,2,-1,1,5,.1", head, "1\n2\n3\n")).station_m.size(), 2U);
}

TEST(ErdProfile, TakesAnotherStepAndItsOwnStart) {
    const std::string head = "UNITSNAMm\nXSTART  100\nXUNITS  ft\n";
    EXPECT_THAT(read_text(erd("1,2,-1,1,5,.1", head, "1\n2\n")).station_m,
                Pointwise(IsNear(), {30.48, 30.51048}));
    EXPECT_EQ(read_text(erd("1,2,-1,1,5,.1", head, "1\n2\n"), 0.25).even_step_m, 0.25);
}

TEST(ErdProfile, ReadsFloatsBesideTheHeader) {
    std::string numbers;
    for (const float z : {1.5F, -2.0F, 0.125F, 1e-3F}) {
        numbers += little_endian(std::bit_cast<std::uint32_t>(z), 4);
    }
    const auto profile =
        read_binary(erd("2,2,1,16,1,.1", "UNITSNAMin      mm\nXUNITS  m\n", ""), numbers);
    EXPECT_THAT(profile.tracks[0].elevation_m, Pointwise(IsNear(), {1.5 * 0.0254, 0.125 * 0.0254}));
    EXPECT_THAT(profile.tracks[1].elevation_m, Pointwise(IsNear(), {-0.002, double{1e-3F} / 1000}));
}

TEST(ErdProfile, ReadsIntegersWithTheirGain) {
    const auto numbers = little_endian(1000, 2) + little_endian(65535, 2); // 1000 and -1
    const auto profile =
        read_binary(erd("1,2,1,4,0,.1", "UNITSNAMin\nXUNITS  m\nGAIN    0.001\n", ""), numbers);
    EXPECT_THAT(profile.tracks[0].elevation_m, Pointwise(IsNear(), {0.0254, -2.54e-5}));
}

TEST(ErdProfile, SaysWhatItsHeadLacks) {
    const std::string head = "UNITSNAMm\nXUNITS  m\n";
    EXPECT_THAT(refusal_of_text("station_m,left_m\n"),
                EndsWith("a.erd:1: 'station_m,left_m', expected 'ERDFILEV2.00'"));
    EXPECT_THAT(refusal_of_text(erd("1,2,-1,1,5", head, "")),
                EndsWith("a.erd:2: '1,2,-1,1,5', expected six numbers: channels, samples, records, "
                         "bytes of a record, key number and step"));
    EXPECT_THAT(refusal_of_text(erd("1,2,-1,1,7,.1", head, "")),
                EndsWith("a.erd:2: key number '7', expected 5 (text), or 0 or 1 (2-byte integers "
                         "or 4-byte floats in a .bin)"));
    EXPECT_THAT(refusal_of_text(erd("0,2,-1,1,5,.1", head, "")),
                EndsWith("a.erd:2: number of channels '0', expected 1 to 1000"));
    EXPECT_THAT(refusal_of_text(erd("1,2.5,-1,1,5,.1", head, "")),
                EndsWith("number of samples '2.5', expected a whole number"));
    EXPECT_THAT(refusal_of_text("ERDFILEV2.00\n1,2,-1,1,5,.1\nUNITSNAMm\n"),
                EndsWith("a.erd:3: ends here, expected the end of the header, END"));
    EXPECT_THAT(refusal_of_text(erd("2,2,-1,1,5,.1", "UNITSNAMg       deg\nXUNITS  m\n", "")),
                EndsWith("a.erd: no channel is an elevation: UNITSNAM has 'g' 'deg', expected m, "
                         "cm, mm, um, ft, in or mil"));
    EXPECT_THAT(refusal_of_text(erd("1,2,-1,1,5,.1", "UNITSNAMm\nXUNITS  s\n", "")),
                EndsWith("a.erd: has no step in a unit of length, expected XUNITS m, cm, mm, "
                         "um, ft, in or mil or the option --step"));
}

TEST(ErdProfile, SaysWhichLineOfNumbersIsWrong) {
    const std::string head = "UNITSNAMm       m\nXUNITS  m\n";
    EXPECT_THAT(refusal_of_text(erd("2,2,-1,1,5,.1", head, "1 2\n3 bump\n")),
                EndsWith("a.erd:7: '3 bump', expected numbers"));
    EXPECT_THAT(refusal_of_text(erd("2,2,-1,1,5,.1", head, "1 2\n3 nan\n")),
                EndsWith("a.erd:7: '3 nan', expected numbers"));
    EXPECT_THAT(refusal_of_text(erd("2,3,-1,1,5,.1", head, "1 2\n3 4\n")),
                EndsWith("a.erd: has 2 samples, expected the 3 of its header"));
    EXPECT_THAT(refusal_of_text(erd("2,-1,-1,1,5,.1", head, "1 2\n3\n")),
                EndsWith("a.erd:7: ends within a sample: 1 of 2 numbers"));
}

TEST(ErdProfile, RefusesAStepTooSmallForItsStations) {
    EXPECT_THAT(
        refusal_of_text(erd("1,2,-1,1,5,1e-9", "UNITSNAMm\nXUNITS  m\nXSTART  1e9\n", "1\n2\n")),
        EndsWith("a.erd: point 2 is at 1000000000 m, expected more than 1000000000"));
}

TEST(ErdProfile, SaysThatTheNumbersBesideItAreNotThere) {
    const auto file =
        written(test_folder(), "a.erd", erd("1,2,1,8,1,.1", "UNITSNAMm\nXUNITS  m\n", ""));
    EXPECT_THAT(refusal_of([&] { read_profile(file, {}); }),
                HasSubstr("a.bin: cannot be read: No such file or directory"));
}
