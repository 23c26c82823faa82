#include "app/cli/commands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace macadam {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

TEST(Commands, AreFoundByTheirNames) {
    for (const auto& command : commands()) {
        EXPECT_EQ(command_named(command.name)->summary, command.summary);
    }
    EXPECT_EQ(command_named("fly"), nullptr);
}

TEST(Commands, HaveOneNameEach) {
    ASSERT_GT(commands().size(), 20U);
    for (const auto& command : commands()) {
        EXPECT_EQ(std::ranges::count(commands(), command.name, &Command::name), 1) << command.name;
    }
}

TEST(Help, OfEveryCommandNamesEachOptionAndGivesAnExampleOfIt) {
    ASSERT_GT(commands().size(), 20U);
    for (const auto& command : commands()) {
        const auto help = help_of(command, HelpDetail::all);
        EXPECT_THAT(help, HasSubstr("usage: macadam " + std::string{command.name}));
        EXPECT_THAT(help, HasSubstr("example\n  macadam " + std::string{command.name} + " "));
        for (const auto& option : command.options) {
            EXPECT_THAT(help, HasSubstr(std::string{option.help}));
        }
    }
}

TEST(Help, LeavesRareOptionsToHelpAllAndSaysHowMany) {
    const auto usual = help_of(init_command);
    EXPECT_THAT(usual, HasSubstr("--network"));
    EXPECT_THAT(usual, Not(HasSubstr("--highway-column")));
    EXPECT_THAT(usual, HasSubstr("9 more options are rarely needed: macadam init --help-all"));
    EXPECT_THAT(help_of(init_command, HelpDetail::all), HasSubstr("--highway-column"));
}

TEST(Help, SetsOptionsOfOneKindUnderOneHeading) {
    const auto help = help_of(query_command);
    for (const auto* const heading : {"\noptions\n", "\nselection\n", "\nsections\n"}) {
        EXPECT_THAT(help, HasSubstr(heading));
        EXPECT_EQ(help.find(heading), help.rfind(heading)) << heading;
    }
    EXPECT_LT(help.find("--quiet"), help.find("\nselection\n")); // "options" comes first
}

TEST(Options, WithChoicesNameThemInTheirHelpAndHaveTheFirstByDefault) {
    std::size_t count = 0;
    for (const auto& command : commands()) {
        for (const auto& option : command.options) {
            const auto choices = choices_in(option.choices);
            if (!choices.empty() && option.fallback == "by the suffix of -o; otherwise csv") {
                EXPECT_EQ(choices.front(), "csv") << command.name << option.name;
            } else if (!choices.empty() && !option.fallback.empty() &&
                       option.fallback != "as in the database") {
                EXPECT_EQ(choices.front(), option.fallback) << command.name << option.name;
            }
            count += choices.empty() ? 0 : 1;
        }
    }
    EXPECT_GT(count, 20U);
}

TEST(Commands, ThatChooseTheCarOfALogCanBeToldWhichItIs) {
    std::size_t count = 0;
    for (const auto& command : commands()) {
        const auto has = [&](std::string_view name) {
            return std::ranges::count(command.options, name, &Option::name) == 1;
        };
        if (has("--vehicle")) {
            EXPECT_TRUE(has("--vehicles") && has("--vehicle-id")) << command.name;
            ++count;
        }
    }
    EXPECT_GE(count, 5U);
}

TEST(Commands, ThatPrintRowsHaveAFormatAFileAndTheShortFormOfJson) {
    std::vector<std::string_view> found;
    for (const auto& command : commands()) {
        const auto has = [&](std::string_view name) {
            return std::ranges::count(command.options, name, &Option::name) == 1;
        };
        const bool is_of_files = command.name == convert_command.name ||
                                 command.name == export_command.name ||
                                 command.name == render_command.name;
        if (has("--format") && !is_of_files) {
            EXPECT_TRUE(has("-o,--output") && has("--json")) << command.name;
            found.push_back(command.name);
        }
    }
    EXPECT_THAT(found,
                UnorderedElementsAre("query",
                                     "status",
                                     "trace",
                                     "match",
                                     "iri",
                                     "valid-from",
                                     "vehicles",
                                     "info",
                                     "compare",
                                     "calibrate",
                                     "identify",
                                     "report"));
}

TEST(Commands, ThatAreMisspelledAreAnsweredWithTheNearestOne) {
    EXPECT_EQ(refusal_of_command("imprt"), "unknown command 'imprt'; did you mean import?");
    EXPECT_EQ(refusal_of_command("hepl"), "unknown command 'hepl'; did you mean help?");
    EXPECT_EQ(refusal_of_command("fly"),
              "unknown command 'fly'; macadam --help lists all commands");
}

TEST(Help, OfAllNamesEveryCommand) {
    ASSERT_GT(commands().size(), 20U);
    const auto help = help_of_all(1);
    for (const auto& command : commands()) {
        EXPECT_THAT(help, HasSubstr("  " + std::string{command.name} + " "));
    }
}

TEST(Help, KeepsItsLinesWithinAScreen) {
    ASSERT_GT(commands().size(), 20U);
    constexpr std::size_t screen_columns = 132;
    for (const auto& command : commands()) {
        std::istringstream lines{help_of(command, HelpDetail::all)};
        for (std::string line; std::getline(lines, line);) {
            EXPECT_LE(line.size(), screen_columns) << line;
        }
    }
}

TEST(Commands, RefuseWhatTheyDoNotKnowBeforeTheyOpenAnything) {
    ASSERT_GT(commands().size(), 20U);
    for (const auto& command : commands()) {
        EXPECT_THROW(run(command, {"--no-such-option"}), UsageError) << command.name;
    }
}

} // namespace
} // namespace macadam
