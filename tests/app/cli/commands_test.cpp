#include "app/cli/commands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace macadam {
namespace {

using ::testing::HasSubstr;

TEST(Commands, AreFoundByTheirNames) {
    for (const auto& command : commands()) {
        EXPECT_EQ(command_named(command.name)->summary, command.summary);
    }
    EXPECT_EQ(command_named("fly"), nullptr);
}

TEST(Commands, HaveOneNameEach) {
    for (const auto& command : commands()) {
        EXPECT_EQ(std::ranges::count(commands(), command.name, &Command::name), 1) << command.name;
    }
}

TEST(Help, OfEveryCommandNamesEachOptionAndGivesAnExampleOfIt) {
    for (const auto& command : commands()) {
        const auto help = help_of(command);
        EXPECT_THAT(help, HasSubstr("usage: macadam " + std::string{command.name}));
        EXPECT_THAT(help, HasSubstr("example\n  macadam " + std::string{command.name} + " "));
        for (const auto& option : command.options) {
            EXPECT_THAT(help, HasSubstr(std::string{option.help}));
        }
    }
}

TEST(Help, OfAllNamesEveryCommand) {
    const auto help = help_of_all();
    for (const auto& command : commands()) {
        EXPECT_THAT(help, HasSubstr("  " + std::string{command.name} + " "));
    }
}

TEST(Help, KeepsItsLinesWithinAScreen) {
    constexpr std::size_t screen_columns = 132;
    for (const auto& command : commands()) {
        std::istringstream lines{help_of(command)};
        for (std::string line; std::getline(lines, line);) {
            EXPECT_LE(line.size(), screen_columns) << line;
        }
    }
}

TEST(Commands, RefuseWhatTheyDoNotKnowBeforeTheyOpenAnything) {
    for (const auto& command : commands()) {
        EXPECT_THROW(run(command, {"--no-such-option"}), UsageError) << command.name;
    }
}

} // namespace
} // namespace macadam
