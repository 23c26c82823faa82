#include "render/text.hpp"

#include <gmock/gmock.h>

#include <numeric>

namespace macadam::testing {
namespace {

constexpr TextLook look{.size_px = 20, .bold = false};

} // namespace

TEST(Text, GrowsWithItsSize) {
    TypeSetter setter;
    const double small_px = setter.width_px("Roughness", look);
    EXPECT_NEAR(setter.width_px("Roughness", {40, false}), 2 * small_px, 0.02 * small_px);
}

TEST(Text, IsAsTallAsItsCapitals) {
    TypeSetter setter;
    const auto mask = setter.mask("H", look);
    EXPECT_NEAR(-mask.top, 0.729 * 20, 1); // cap height of DejaVu Sans in ems, to the pixel
    EXPECT_EQ(mask.height, -mask.top);
}

TEST(Text, SetsScriptsThatTheFontHas) {
    TypeSetter setter;
    const auto unknown = setter.mask("\xF3\xBF\xBF\xBD", look).coverage;
    for (const auto* letter : {"ß", "Ω", "Ж", "ش", "–"}) {
        EXPECT_NE(setter.mask(letter, look).coverage, unknown) << letter;
    }
}

TEST(Text, ReplacesBytesThatAreNotUtf8) {
    TypeSetter setter;
    EXPECT_EQ(setter.mask("a\xFFz", look).coverage, setter.mask("a\uFFFDz", look).coverage);
}

TEST(Text, BreaksBetweenWords) {
    TypeSetter setter;
    const double room_px = setter.width_px("rough roads", look) + 1;
    EXPECT_THAT(setter.wrapped("rough roads ahead", look, room_px),
                ::testing::ElementsAre("rough roads", "ahead"));
}

TEST(Text, LosesNoLetterOfAWordThatIsTooLong) {
    TypeSetter setter;
    const std::string word = "Straßenzustandsübersichtskarte";
    const auto lines = setter.wrapped(word, look, 100);
    EXPECT_GT(lines.size(), 2U);
    EXPECT_EQ(std::accumulate(lines.begin(), lines.end(), std::string{}), word);
    for (const auto& line : lines) {
        EXPECT_LE(setter.width_px(line, look), 100) << line;
    }
}

} // namespace macadam::testing
