#include "storage/settings/style_file.hpp"

#include "support/files/files.hpp"
#include "support/program/places.hpp"

#include <gmock/gmock.h>

#include <cmath>

using namespace macadam;
using namespace macadam::testing;
using ::testing::ElementsAre;
using ::testing::EndsWith;

namespace {

MapLook read_text(const std::string& text) {
    return read_style(written(test_folder(), "mine.toml", text));
}

/// The refusal without the folder.
std::string refusal_of_text(const std::string& text) {
    const auto words = refusal_of([&] { read_text(text); });
    const auto file = words.find("mine.toml");
    return file == std::string::npos ? words : words.substr(file);
}

} // namespace

TEST(StyleFile, OfNothingChangesNothing) {
    const auto look = read_text("");
    EXPECT_FALSE(look.own_table || look.shipped_table || look.ramp || look.theme || look.unit);
    EXPECT_TRUE(look.own_ramp.empty());
    EXPECT_EQ(look.lines.width, 1);
    EXPECT_FALSE(look.min_passes);
}

TEST(StyleFile, HasClassesInTheOrderOfTheFile) {
    const auto look = read_text("[[class]]\nname = \"smooth\"\nbelow = 1.5\n"
                                "[[class]]\nname = \"so so\"\nup_to = 4\n"
                                "[[class]]\nname = \"rough\"\n");
    const auto& table = look.own_table->table();
    EXPECT_EQ(table.name, "mine");
    ASSERT_EQ(table.classes.size(), 3U);
    EXPECT_EQ(table.classes[1].name, "so so");
    EXPECT_EQ(class_index(table, 1.499), 0U);
    EXPECT_EQ(class_index(table, 1.5), 1U); // below: the border is the next class's
    EXPECT_EQ(class_index(table, 4), 1U);   // up_to: the border is its own
    EXPECT_EQ(class_index(table, 4.001), 2U);
}

TEST(StyleFile, HasBordersInInchesPerMileIfItSaysSo) {
    const auto look = read_text("unit = \"in/mi\"\n"
                                "[[class]]\nname = \"good\"\nbelow = 95\n"
                                "[[class]]\nname = \"fair\"\nup_to = 170\n"
                                "[[class]]\nname = \"poor\"\n");
    const auto& shipped = class_table("fhwa")->classes;
    const auto& own = look.own_table->table().classes;
    EXPECT_EQ(own[0].to_mm_per_m, shipped[0].to_mm_per_m);
    EXPECT_EQ(own[1].to_mm_per_m, shipped[1].to_mm_per_m);
    EXPECT_TRUE(std::isinf(own[2].to_mm_per_m));
}

TEST(StyleFile, KeepsItsWordsWhenItIsCopied) {
    auto look = std::make_unique<MapLook>(
        read_text("[[class]]\nname = \"a\"\nup_to = 1\n[[class]]\nname = \"b\"\n"));
    const auto copy = *look;
    look.reset();
    EXPECT_EQ(copy.own_table->table().classes[1].name, "b");
}

TEST(StyleFile, HasARampByNameOrInColours) {
    EXPECT_EQ(read_text("ramp = \"viridis\"").ramp, "viridis");
    EXPECT_THAT(read_text("[ramp]\ncolours = [\"#000102\", \"#Ffffff\"]").own_ramp,
                ElementsAre(0x000102, 0xffffff));
}

TEST(StyleFile, HasColoursWidthsPassesAndWords) {
    const auto look = read_text("theme = \"dark\"\nmin_passes = 3\n"
                                "[colours]\nground = \"#102030\"\n"
                                "[lines]\nwidth = 1.5\n"
                                "[legend]\nfew_passes = \"unter {} Fahrten\"\ntitle = \"IRI\"\n");
    EXPECT_EQ(look.theme, "dark");
    EXPECT_EQ(look.min_passes, 3);
    EXPECT_EQ(look.colours.ground, 0x102030U);
    EXPECT_FALSE(look.colours.casing);
    EXPECT_EQ(look.lines.width, 1.5);
    EXPECT_EQ(look.lines.casing, 1);
    EXPECT_EQ(look.words.few_passes, "unter {} Fahrten");
    EXPECT_EQ(look.words.title, "IRI");
    EXPECT_EQ(look.words.uncertain, "Uncertain");
}

TEST(StyleFile, RefusesUnknownKeysWithTheirLine) {
    EXPECT_EQ(refusal_of_text("theme = \"dark\"\ncolors = 3\n"),
              "mine.toml:2: unknown key 'colors', expected theme, unit, classes, class, ramp, "
              "colours, lines, min_passes, legend");
    EXPECT_EQ(refusal_of_text("[colours]\nsky = \"#ffffff\"\n"),
              "mine.toml:2: unknown key 'colours.sky', expected page, ground, border, ink, "
              "quiet_ink, casing, unmeasured, few_passes");
}

TEST(StyleFile, RefusesWhatIsNoColour) {
    for (const std::string text : {"red", "#12345", "#12345g", "#1234567", "1234567", "#+12345"}) {
        EXPECT_EQ(refusal_of_text("\n[colours]\nink = \"" + text + "\"\n"),
                  "mine.toml:3: 'colours.ink' is '" + text +
                      "', expected a colour such as \"#2c7bb6\"");
        EXPECT_EQ(refusal_of_text("[ramp]\ncolours = [\"#ffffff\", \"" + text + "\"]\n"),
                  "mine.toml:2: 'ramp.colours' has '" + text +
                      "', expected colours such as \"#2c7bb6\"");
    }
}

TEST(StyleFile, RefusesARampOfOneColour) {
    EXPECT_EQ(refusal_of_text("[ramp]\ncolours = [\"#ffffff\"]\n"),
              "mine.toml:2: 'ramp.colours' is an array, expected 2 to 64 colours such as "
              "\"#2c7bb6\"");
}

TEST(StyleFile, RefusesBordersThatDoNotRise) {
    EXPECT_EQ(refusal_of_text("[[class]]\nname = \"a\"\nup_to = 2\n"
                              "[[class]]\nname = \"b\"\nup_to = 1.5\n"
                              "[[class]]\nname = \"c\"\n"),
              "mine.toml:6: 'class.up_to' is '1.5', expected more than 2, the previous limit");
}

TEST(StyleFile, RefusesABorderOfTheLastClassAndNoneOfAnother) {
    EXPECT_EQ(refusal_of_text("[[class]]\nname = \"a\"\nup_to = 2\n"
                              "[[class]]\nname = \"b\"\nup_to = 3\n"),
              "mine.toml:6: 'class.up_to' is '3', expected no limit, as the last class has none");
    EXPECT_EQ(refusal_of_text("[[class]]\nname = \"a\"\n[[class]]\nname = \"b\"\n"),
              "mine.toml:2: 'class.name' is 'a', expected a limit too: up_to or below; only "
              "the last class has none");
    EXPECT_EQ(refusal_of_text("[[class]]\nname = \"a\"\nup_to = 2\nbelow = 2\n"
                              "[[class]]\nname = \"b\"\n"),
              "mine.toml:4: 'class.below' is '2', expected only one of up_to and below");
}

TEST(StyleFile, RefusesTooFewAndTooManyClasses) {
    EXPECT_EQ(refusal_of_text("[[class]]\nname = \"a\"\n"),
              "mine.toml:1: 1 classes, expected 2 to 12");
    std::string many;
    for (int i = 1; i <= 13; ++i) {
        many += "[[class]]\nname = \"" + std::to_string(i) + "\"\n";
        many += i < 13 ? "up_to = " + std::to_string(i) + "\n" : "";
    }
    EXPECT_EQ(refusal_of_text(many), "mine.toml:1: 13 classes, expected 2 to 12");
}

TEST(StyleFile, RefusesTwoClassesOfOneName) {
    EXPECT_EQ(refusal_of_text("[[class]]\nname = \"a\"\nup_to = 2\n[[class]]\nname = \"a\"\n"),
              "mine.toml:5: 'class.name' is 'a', expected a name that no earlier class has");
}

TEST(StyleFile, RefusesBordersOutsideOfAllRoads) {
    EXPECT_EQ(refusal_of_text("unit = \"in/mi\"\n[[class]]\nname = \"a\"\nup_to = 9000\n"
                              "[[class]]\nname = \"b\"\n"),
              "mine.toml:4: 'class.up_to' is '9000', expected 0.6336 to 6336");
}

TEST(StyleFile, RefusesWordsWithoutAPlaceForTheirValue) {
    EXPECT_EQ(refusal_of_text("[legend]\nbelow = \"unter\"\n"),
              "mine.toml:2: 'legend.below' is 'unter', expected a text with {} once, for the "
              "value");
    EXPECT_EQ(refusal_of_text("[legend]\nbelow = \"{} bis {}\"\n"),
              "mine.toml:2: 'legend.below' is '{} bis {}', expected a text with {} once, for "
              "the value");
}

TEST(StyleFile, RefusesNumbersOutOfRange) {
    EXPECT_EQ(refusal_of_text("[lines]\nwidth = 0\n"),
              "mine.toml:2: 'lines.width' is '0', expected a number from 0.25 to 4");
    EXPECT_THAT(refusal_of_text("min_passes = 0\n"),
                EndsWith("expected a whole number from 1 to 1000000"));
}

TEST(StyleFile, RefusesAShippedTableBesideItsOwn) {
    EXPECT_EQ(refusal_of_text("classes = \"five\"\n[[class]]\nname = \"a\"\nup_to = 1\n"
                              "[[class]]\nname = \"b\"\n"),
              "mine.toml:1: 'classes' is 'five', expected either classes or tables [[class]]");
    EXPECT_EQ(refusal_of_text("ramp = \"jet\"\n"),
              "mine.toml:1: 'ramp' is 'jet', expected one of rdylbu, cividis, viridis");
    EXPECT_EQ(refusal_of_text("classes = \"nine\"\n"),
              "mine.toml:1: 'classes' is 'nine', expected one of fhwa, five");
}

TEST(StyleFile, OfTheSampleAgencyIsReadInFull) {
    const auto look =
        read_style(std::filesystem::path{source_folder()} / "sample_data/styles/agency.toml");
    ASSERT_EQ(look.own_table->table().classes.size(), 4U);
    EXPECT_EQ(look.own_table->table().classes[2].name, "mäßig");
    EXPECT_EQ(look.own_ramp.size(), 4U);
    EXPECT_EQ(look.min_passes, 2);
    EXPECT_EQ(look.words.few_passes, "Weniger als {} Fahrten");
}
