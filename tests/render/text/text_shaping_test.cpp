#include "render/text/text_shaping.hpp"

#include "estimator/common/error.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <string>
#include <unistd.h>

namespace macadam::testing {
namespace {

constexpr TextLook look{.size_px = 20, .bold = false};

std::vector<std::uint32_t> glyphs_of(const SetLine& line) {
    std::vector<std::uint32_t> glyphs;
    for (const auto& glyph : line.glyphs) {
        glyphs.push_back(glyph.index);
    }
    return glyphs;
}

/// A folder with those folders of fonts alone, as on a machine without the other packages.
class FontsOf {
public:
    explicit FontsOf(std::initializer_list<std::string_view> folders)
        : folder{std::filesystem::temp_directory_path() /
                 ("macadam_fonts_" + std::to_string(::getpid()))} {
        std::filesystem::create_directories(folder / "truetype");
        for (const auto below : folders) {
            std::filesystem::create_directory_symlink(
                std::filesystem::path{"/usr/share/fonts"} / below, folder / below);
        }
    }
    ~FontsOf() { std::filesystem::remove_all(folder); }
    FontsOf(const FontsOf&) = delete;
    FontsOf& operator=(const FontsOf&) = delete;

    const std::filesystem::path folder;
};

} // namespace

TEST(Text, GrowsWithItsSize) {
    TypeSetter setter;
    const double small_px = setter.width_px("Roughness", look);
    EXPECT_NEAR(setter.width_px("Roughness", {40, false}), 2 * small_px, 0.02 * small_px);
}

TEST(Text, IsAsTallAsItsCapitals) {
    TypeSetter setter;
    const auto mask = setter.mask("H", look);
    EXPECT_NEAR(-mask.top, 0.714 * 20, 1); // cap height of Noto Sans in ems, to the pixel
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

TEST(Text, SetsRoadNamesOfManyScriptsInFull) {
    TypeSetter setter;
    for (const auto* name : {"Győr–Mosonmagyaróvár, Széchenyi út",
                             "Λεωφόρος Συγγρού",
                             "Тверская улица",
                             "شارع الملك فيصل",
                             "רחוב דיזנגוף",
                             "महात्मा गांधी मार्ग",
                             "ถนนสุขุมวิท",
                             "Đường Nguyễn Huệ",
                             "რუსთაველის გამზირი",
                             "Մաշտոցի պողոտա",
                             "வீதி 12",
                             "ဗိုလ်ချုပ်လမ်း",
                             "中山北路三段",
                             "明治通り",
                             "테헤란로 12"}) {
        const auto line = setter.set(name, look);
        EXPECT_TRUE(line.whole) << name;
        EXPECT_TRUE(std::ranges::none_of(line.glyphs, [](auto& glyph) { return glyph.index == 0; }))
            << name;
    }
}

TEST(Text, GivesHanCharactersTheShapesOfTheLettersBesideThem) {
    // U+9AA8, whose inner corner opens to the other side in China than in Japan and Korea. The
    // faces of the font share their glyphs, so another index is another shape.
    TypeSetter setter;
    const auto bone = [&](std::string_view beside) {
        const auto line = setter.set(std::string{"骨"}.append(beside), look);
        EXPECT_TRUE(line.whole) << beside;
        return line.glyphs.at(0).index;
    };
    const auto chinese = bone("路");
    EXPECT_EQ(bone(""), chinese);
    EXPECT_NE(bone("の"), chinese);
    EXPECT_EQ(bone("カ"), bone("の"));
    EXPECT_EQ(bone("로"), bone("の"));
    EXPECT_NE(bone("ㄅ"), chinese); // Taiwan's
}

TEST(Text, WritesHebrewFromRightToLeft) {
    TypeSetter setter;
    auto logical = glyphs_of(setter.set("ש", look));
    for (const auto* letter : {"ל", "ו", "ם"}) {
        logical.push_back(glyphs_of(setter.set(letter, look)).at(0));
    }
    std::ranges::reverse(logical);
    EXPECT_EQ(glyphs_of(setter.set("שלום", look)), logical);
}

TEST(Text, JoinsArabicLetters) {
    TypeSetter setter;
    const auto alone = glyphs_of(setter.set("س", look));
    const auto word = glyphs_of(setter.set("سسس", look));
    ASSERT_EQ(word.size(), 3U);
    EXPECT_EQ(std::ranges::count(word, alone.at(0)), 0); // initial, medial and final forms
}

TEST(Text, KeepsNumbersOfARightToLeftNameReadable) {
    TypeSetter setter;
    const auto digits = glyphs_of(setter.set("12", look));
    const auto name = glyphs_of(setter.set("רחוב 12", look));
    ASSERT_EQ(name.size(), 7U);
    EXPECT_EQ(name[0], digits[0]); // the number stands left of the word, itself from left to right
    EXPECT_EQ(name[1], digits[1]);
}

TEST(Text, PutsALatinWordBeforeARightToLeftOneOnItsLeft) {
    TypeSetter setter;
    const auto name = glyphs_of(setter.set("Weg שלום", look));
    EXPECT_EQ(name.at(0), glyphs_of(setter.set("W", look)).at(0));
    EXPECT_EQ(name.back(), glyphs_of(setter.set("ש", look)).at(0));
}

TEST(Text, TellsItsCharactersAsTheyStand) {
    EXPECT_EQ(TypeSetter::as_it_stands("Széchenyi út"), "Széchenyi út");
    EXPECT_EQ(TypeSetter::as_it_stands("שלום"), "םולש");
    EXPECT_EQ(TypeSetter::as_it_stands("רחוב 12"), "12 בוחר");
    EXPECT_EQ(TypeSetter::as_it_stands("Weg שלום"), "Weg םולש");
    EXPECT_EQ(TypeSetter::as_it_stands("\xff\x01"), "\uFFFD ");
    EXPECT_EQ(TypeSetter::as_it_stands(""), "");
}

TEST(Text, ReordersVowelsOfDevanagari) {
    TypeSetter setter;
    const auto consonant = glyphs_of(setter.set("क", look)).at(0);
    const auto syllable = glyphs_of(setter.set("कि", look)); // the vowel i stands before its k
    ASSERT_EQ(syllable.size(), 2U);
    EXPECT_EQ(syllable[1], consonant);
}

TEST(Text, KeepsMarksWithTheirLetters) {
    TypeSetter setter;
    const auto line = setter.set("ที่", look); // one letter with a vowel and a tone above it
    ASSERT_EQ(line.clusters.size(), 1U);
    EXPECT_EQ(line.clusters[0].count, line.glyphs.size());
    EXPECT_GE(line.glyphs.size(), 3U);
}

TEST(Text, LeavesOutWhatNoFontHasAndSaysSo) {
    TypeSetter setter;
    const auto line = setter.set("\U0010FFFD Lu", look);
    EXPECT_FALSE(line.whole);
    EXPECT_EQ(glyphs_of(line), glyphs_of(setter.set(" Lu", look)));
}

TEST(Text, AsksForThePackageOfAMissingFont) {
    EXPECT_THAT(
        [] { TypeSetter{"/nowhere"}; },
        ::testing::ThrowsMessage<InputError>(
            "/nowhere/truetype/noto/NotoSans-Regular.ttf: cannot read the font, expected the "
            "package fonts-noto-core"));
}

TEST(Text, HasFiguresOfOneWidth) {
    TypeSetter setter;
    for (const bool bold : {false, true}) {
        const TextLook figures{.size_px = 20, .bold = bold};
        const double width_px = setter.width_px("0", figures);
        for (const char figure : std::string_view{"123456789"}) {
            EXPECT_DOUBLE_EQ(setter.width_px(std::string(1, figure), figures), width_px) << figure;
        }
    }
}

TEST(Text, AsksForThePackageOfTheFontOfChineseCharacters) {
    const FontsOf small{"truetype/noto"};
    TypeSetter setter{small.folder};
    EXPECT_TRUE(setter.set("ถนน", look).whole);
    EXPECT_THAT([&] { setter.set("明治通り", look); },
                ::testing::ThrowsMessage<InputError>(::testing::HasSubstr(
                    "NotoSansCJK-Regular.ttc: cannot read the font, expected the package "
                    "fonts-noto-cjk")));
}

TEST(Text, TurnsAGlyphAboutItsOrigin) {
    TypeSetter setter;
    const auto glyph = setter.set("l", {40}).glyphs.at(0);
    const auto upright = setter.stamp(glyph, {40}, {100, 100});
    const auto fallen = setter.stamp(glyph, {40}, {100, 100, 0, 1}); // reads downwards
    EXPECT_NEAR(fallen.width, upright.height, 1); // hinting moves edges by less than a pixel
    EXPECT_NEAR(fallen.height, upright.width, 1);
    EXPECT_NEAR(fallen.top - 100, upright.left - 100, 1); // what was right of the origin is below
    EXPECT_NEAR(fallen.left + fallen.width - 100, 100 - upright.top, 1); // above became right
}

} // namespace macadam::testing
