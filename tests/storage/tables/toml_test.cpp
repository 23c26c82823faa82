#include "storage/tables/toml.hpp"

#include "support/files/files.hpp"

#include <gmock/gmock.h>

using namespace macadam;
using namespace macadam::testing;

namespace {

const auto recipe = parse_toml("seed = 7\nname = \"a fleet\"\nwet = true\nempty = \"\"\n"
                               "bias = [1, 2.5, -3]\nkinds = [\"van\", \"suv\"]\n"
                               "[gnss]\nrate_hz = 0\n"
                               "[[car]]\nname = \"one\"\n[[car]]\nname = \"two\"\n",
                               "recipe.toml");

} // namespace

TEST(Toml, GivesWhatStandsThere) {
    EXPECT_EQ(recipe.integer("seed", 1, 10), 7);
    EXPECT_EQ(recipe.number("seed"), 7);
    EXPECT_EQ(recipe.text("name"), "a fleet");
    EXPECT_EQ(recipe.text_or_empty("empty"), "");
    EXPECT_TRUE(recipe.flag("wet"));
    EXPECT_THAT(recipe.numbers("bias"), ::testing::ElementsAre(1, 2.5, -3));
    EXPECT_THAT(recipe.texts("kinds"), ::testing::ElementsAre("van", "suv"));
    EXPECT_EQ(recipe.table("gnss")->number("rate_hz"), 0);
    ASSERT_EQ(recipe.tables("car").size(), 2U);
    EXPECT_EQ(recipe.tables("car")[1].text("name"), "two");
}

TEST(Toml, RefusesWhatMakesItsParserGiveUp) {
    for (const std::string text : {"[[=", "t = 2026-03-01T:", "\u00e9 = 1", "a = 1 \u02a5"}) {
        EXPECT_THAT(refusal_of([&] { parse_toml(text, "a.toml"); }),
                    ::testing::StartsWith("a.toml"))
            << text;
    }
}

TEST(Toml, GivesNothingForWhatMayBeMissing) {
    EXPECT_FALSE(recipe.maybe_number("mass_kg"));
    EXPECT_FALSE(recipe.maybe_text("colour"));
    EXPECT_FALSE(recipe.maybe_flag("dry"));
    EXPECT_FALSE(recipe.table("imu"));
    EXPECT_TRUE(recipe.tables("road").empty());
}

TEST(Toml, RefusesWithFileLineValueAndExpectation) {
    EXPECT_EQ(refusal_of([] { recipe.table("gnss")->number("rate_hz", positive_number); }),
              "recipe.toml:8: 'gnss.rate_hz' is '0', expected a number above 0");
    EXPECT_EQ(refusal_of([] { recipe.integer("seed", 8, 9); }),
              "recipe.toml:1: 'seed' is '7', expected a whole number from 8 to 9");
    EXPECT_EQ(refusal_of([] { recipe.text("empty"); }),
              "recipe.toml:4: 'empty' is '', expected a text");
    EXPECT_EQ(refusal_of([] { recipe.flag("name"); }),
              "recipe.toml:2: 'name' is 'a fleet', expected true or false");
    EXPECT_EQ(refusal_of([] { recipe.numbers("kinds"); }),
              "recipe.toml:6: 'kinds' is 'van', expected an array, each a number");
    EXPECT_EQ(refusal_of([] { recipe.tables("gnss"); }),
              "recipe.toml:7: 'gnss' is a table, expected [[gnss]]");
    EXPECT_EQ(refusal_of([] { recipe.table("name"); }),
              "recipe.toml:2: 'name' is 'a fleet', expected [name]");
}

TEST(Toml, NamesTheKeyThatIsMissingOrUnknown) {
    EXPECT_EQ(refusal_of([] { recipe.number("mass_kg"); }),
              "recipe.toml:1: the key 'mass_kg' is missing");
    EXPECT_EQ(
        refusal_of([] {
            constexpr std::string_view known[] = {
                "seed", "wet", "bias", "kinds", "car", "empty", "name"};
            recipe.expect_only(known);
        }),
        "recipe.toml:7: unknown key 'gnss', expected seed, wet, bias, kinds, car, empty, name");
}

TEST(Toml, SaysWhereTextIsNoToml) {
    EXPECT_THAT(refusal_of([] { parse_toml("a = 1\nb = = 2\n", "x.toml"); }),
                ::testing::StartsWith("x.toml:2: "));
}
