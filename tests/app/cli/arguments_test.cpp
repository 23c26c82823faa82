#include "app/cli/arguments.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

namespace macadam {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::array options{Option{"--length", "METRES", "How long."},
                             Option{"-o,--output", "FILE", "Where to."},
                             Option{"--bbox", "W,S,E,N", "What."},
                             Option{"--trace", "TRIP", "From these.", "", true},
                             Option{"--json", "", "As JSON."}};
constexpr std::array operands{Operand{"STORE", "The store."}};

Arguments parse(std::vector<std::string> words) {
    return {options, operands, std::move(words)};
}

std::string refusal(std::vector<std::string> words) {
    try {
        parse(std::move(words));
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

TEST(Arguments, AreSortedByTheTableWhateverTheirOrder) {
    const auto arguments = parse({"--length", "20", "a.gpkg", "-o", "b.csv", "--json"});
    EXPECT_EQ(arguments.operand("STORE"), "a.gpkg");
    EXPECT_EQ(arguments.number("--length"), 20);
    EXPECT_EQ(arguments.value("--output"), "b.csv");
    EXPECT_TRUE(arguments.flag("--json"));
}

TEST(Arguments, NotGivenAreNothing) {
    const auto arguments = parse({"a.gpkg"});
    EXPECT_EQ(arguments.number("--length"), std::nullopt);
    EXPECT_EQ(arguments.number("--length", 7), 7);
    EXPECT_FALSE(arguments.flag("--json"));
}

TEST(Arguments, AskedForWhatTheTableDoesNotHaveAreAMistakeOfTheProgram) {
    EXPECT_THROW(parse({"a.gpkg"}).value("--lenght"), std::logic_error);
    EXPECT_THROW(parse({"a.gpkg"}).operand("TRIP"), std::logic_error);
}

TEST(Arguments, TakeNumbersThatBeginWithAMinus) {
    const auto box = parse({"a.gpkg", "--bbox", "-122.5,37.7,-122.4,37.8"}).numbers("--bbox", 4);
    EXPECT_THAT(*box, ElementsAre(-122.5, 37.7, -122.4, 37.8));
}

TEST(Arguments, LeaveTheOperandToItselfAfterAListOfValues) {
    const auto arguments = parse({"--trace", "a", "b", "store.gpkg"});
    EXPECT_THAT(arguments.values("--trace"), ElementsAre("a", "b"));
    EXPECT_EQ(arguments.operand("STORE"), "store.gpkg");
}

TEST(Arguments, KeepEachValueOfAnOptionThatCanBeRepeatedAndOtherwiseTheLast) {
    constexpr std::array both{repeatable({"--site", "SITE", "These."}),
                              Option{"--length", "METRES", "How long."}};
    const Arguments arguments{
        both, operands, {"--site", "a", "--length", "1", "roads", "--site=b", "--length", "2"}};
    EXPECT_THAT(arguments.values("--site"), ElementsAre("a", "b"));
    EXPECT_THAT(arguments.values("--length"), ElementsAre("2"));
    EXPECT_EQ(arguments.operand("STORE"), "roads");
}

TEST(Arguments, LeaveTheOperandsToThemselvesBesideAValueThatMayBeLeftOut) {
    constexpr std::array excel{Option{"--excel", "[LOCALE]", "For Excel."}};
    constexpr std::array two{Operand{"A", "One."}, Operand{"B", "Another."}};
    const auto parse_two = [&](std::vector<std::string> words) {
        const Arguments arguments{excel, two, std::move(words)};
        return arguments.operand("A") + " " + arguments.operand("B") + " " +
               arguments.value("--excel").value_or("(no --excel)");
    };
    EXPECT_EQ(parse_two({"--excel", "a", "b"}), "a b ");
    EXPECT_EQ(parse_two({"a", "--excel", "b"}), "a b ");
    EXPECT_EQ(parse_two({"a", "b", "--excel"}), "a b ");
    EXPECT_EQ(parse_two({"--excel", "de", "a", "b"}), "a b de");
    EXPECT_EQ(parse_two({"a", "--excel=de", "b"}), "a b de");
    EXPECT_EQ(parse_two({"a", "b", "--excel", "de"}), "a b de");
    EXPECT_THROW(parse_two({"--excel", "a"}), UsageError);
}

TEST(Arguments, RefuseWhatTheTableDoesNotKnow) {
    EXPECT_THAT(refusal({"a.gpkg", "--fast"}), HasSubstr("--fast"));
    EXPECT_THAT(refusal({"a.gpkg", "b.gpkg"}), HasSubstr("b.gpkg"));
}

TEST(Arguments, SuggestTheOptionThatIsSpelledAlike) {
    EXPECT_EQ(refusal({"a.gpkg", "--lenght", "20"}),
              "unknown option --lenght; did you mean --length?");
    EXPECT_EQ(refusal({"a.gpkg", "--bbx=1,2,3,4"}), "unknown option --bbx; did you mean --bbox?");
    EXPECT_EQ(refusal({"a.gpkg", "--outputs", "b"}),
              "unknown option --outputs; did you mean --output?");
    EXPECT_EQ(refusal({"a.gpkg", "--fast"}), "unknown option --fast");
}

TEST(Arguments, NameTheOptionWhoseValueIsSplit) {
    const std::string split = "unexpected '48.40'; --bbox takes one value, W,S,E,N";
    EXPECT_EQ(refusal({"a.gpkg", "--bbox", "15.5", "48.40", "15.6", "48.5"}), split);
    EXPECT_EQ(refusal({"--bbox", "15.5", "48.40", "a.gpkg"}), split);
    EXPECT_EQ(refusal({"a.gpkg", "--length", "20", "m"}),
              "unexpected 'm'; --length takes one value, METRES");
    EXPECT_EQ(refusal({"--length", "20", "a.gpkg", "b.gpkg"}), "unexpected 'b.gpkg'");
    EXPECT_EQ(refusal({"a.gpkg", "-o", "a.csv", "b.csv"}),
              "unexpected 'b.csv'; --output takes one value, FILE");
}

TEST(Arguments, NameTheOperandThatIsMissing) {
    EXPECT_EQ(refusal({"--json"}), "STORE is missing");
}

TEST(Arguments, GiveTheLastOperandAllWordsThatAreLeft) {
    constexpr std::array two{Operand{"STORE", "The store."}, Operand{"PATH", "Trips.", true}};
    const Arguments arguments{options, two, {"a.gpkg", "b", "--json", "c"}};
    EXPECT_EQ(arguments.operand("STORE"), "a.gpkg");
    EXPECT_THAT(arguments.operands("PATH"), ElementsAre("b", "c"));
    try {
        Arguments(options, two, {"a.gpkg"});
        FAIL() << "did without PATH";
    } catch (const UsageError& error) {
        EXPECT_STREQ(error.what(), "PATH is missing");
    }
}

TEST(Arguments, RefuseAnOptionWithoutItsValue) {
    EXPECT_THAT(refusal({"a.gpkg", "--length"}), HasSubstr("--length"));
}

TEST(Arguments, RefuseAValueForAFlag) {
    EXPECT_THAT(refusal({"a.gpkg", "--json=k"}), HasSubstr("--json"));
    EXPECT_THAT(refusal({"a.gpkg", "--json=2"}), HasSubstr("--json"));
}

TEST(Arguments, QuoteAWordThatIsNoNumber) {
    const auto arguments = parse({"a.gpkg", "--length", "20m"});
    try {
        arguments.number("--length");
        FAIL() << "took '20m' as a number";
    } catch (const UsageError& error) {
        EXPECT_STREQ(error.what(), "--length is '20m', expected a number");
    }
}

TEST(Arguments, RefuseABoxOfThreeNumbers) {
    const auto arguments = parse({"a.gpkg", "--bbox", "1,2,3"});
    EXPECT_THROW(arguments.numbers("--bbox", 4), UsageError);
}

constexpr std::array renamed{
    one_of("light|dark", {"--theme", "NAME", "Look."}),
    formerly("--name", {"--road", "TEXT", "Which road."}),
    instead_of("--min-passes", {"--grey-below", "N", "What is grey."}),
};

Arguments parse_renamed(std::vector<std::string> words) {
    return {renamed, operands, std::move(words)};
}

std::string refusal_of_renamed(std::vector<std::string> words) {
    try {
        parse_renamed(std::move(words));
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

TEST(Arguments, RefuseAWordThatIsNoneOfTheChoices) {
    EXPECT_EQ(refusal_of_renamed({"a.gpkg", "--theme", "blue"}),
              "--theme is 'blue', expected light or dark");
}

TEST(Arguments, TakeChoicesWhateverTheirCaseAndTheFirstByDefault) {
    EXPECT_EQ(parse_renamed({"a.gpkg", "--theme", "Dark"}).choice("--theme"), "dark");
    EXPECT_EQ(parse_renamed({"a.gpkg"}).choice("--theme"), "light");
    EXPECT_THAT(parse_renamed({"a.gpkg"}).choices("--theme"), ElementsAre("light", "dark"));
    EXPECT_THROW(parse_renamed({"a.gpkg"}).choice("--road"), std::logic_error);
}

TEST(Arguments, TakeAnEarlierSpellingWithANote) {
    for (const auto& words : {std::vector<std::string>{"a.gpkg", "--name", "Ring"},
                              std::vector<std::string>{"--name=Ring", "a.gpkg"}}) {
        const auto arguments = parse_renamed(words);
        EXPECT_EQ(arguments.value("--road"), "Ring");
        EXPECT_THAT(arguments.notes(), ElementsAre("--name is called --road now"));
    }
    EXPECT_THAT(parse_renamed({"a.gpkg", "--road", "Ring"}).notes(), ElementsAre());
}

TEST(Arguments, TakeDefaultsOfTheUserWhereTheCommandLineHasNone) {
    const std::vector<Default> defaults{{"--theme", "Dark", "config.toml:1"},
                                        {"--theme", "light", "config.toml:2"},
                                        {"--road", "Ring", "MACADAM_ROAD"},
                                        {"--jobs", "3", "config.toml:3"}}; // no option of it
    auto arguments = parse_renamed({"a.gpkg", "--road", "Main"});
    arguments.adopt(defaults);
    EXPECT_EQ(arguments.choice("--theme"), "dark");
    EXPECT_EQ(arguments.value("--road"), "Main");
    EXPECT_FALSE(arguments.is_given("--theme"));
    EXPECT_TRUE(arguments.is_given("--road"));
    ASSERT_THAT(arguments.defaults(), ::testing::SizeIs(1));
    EXPECT_EQ(arguments.defaults().front().source, "config.toml:1");
}

TEST(Arguments, LeaveOutADefaultThatOnlyOtherCommandsOffer) {
    auto arguments = parse_renamed({"a.gpkg"});
    const std::vector<Default> defaults{{"--theme", "print", "config.toml:1"}};
    arguments.adopt(defaults);
    EXPECT_EQ(arguments.choice("--theme"), "light");
    EXPECT_FALSE(arguments.is_given("--theme"));
}

TEST(Arguments, RefuseAnEarlierSpellingThatMeantSomethingElse) {
    EXPECT_EQ(refusal_of_renamed({"a.gpkg", "--min-passes", "3"}),
              "--min-passes is called --grey-below here now");
}

} // namespace
} // namespace macadam
