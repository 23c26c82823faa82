// Manual pages and completions of shells, made from the table of commands.
#include "app/manual/bash_completion.hpp"
#include "app/manual/fish_completion.hpp"
#include "app/manual/man_page.hpp"
#include "app/manual/value_hint.hpp"
#include "app/manual/zsh_completion.hpp"
#include "support/program/program.hpp"
#include "support/program/shell.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace macadam::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const Option& option_of(const Command& command, std::string_view name) {
    return *std::ranges::find(command.options, name, &Option::name);
}

/// Returns what bash offers for the last of the words.
std::string offered(const std::vector<std::string>& words) {
    const auto folder = fresh_folder();
    for (const auto* const name : {"roads.gpkg", "map.png", "map.txt"}) {
        write_file(folder / name, "");
    }
    write_file(folder / "completion", bash_completion());
    std::string list;
    for (const auto& word : words) {
        list += fmt::format("'{}' ", word);
    }
    write_file(folder / "script",
               fmt::format("compopt() {{ :; }}\n. ./completion\nCOMP_WORDS=({})\nCOMP_CWORD={}\n"
                           "_macadam\necho \"${{COMPREPLY[*]}}\"\n",
                           list,
                           words.size() - 1));
    return output_of(folder, fmt::format("cd '{}' && bash ./script", folder.string()));
}

TEST(ManualPage, OfACommandNamesAllOfItsOptions) {
    for (const auto& command : commands()) {
        const auto page = man_page_of(command, "1.2.3");
        EXPECT_THAT(page, HasSubstr("\"Macadam 1.2.3\""));
        for (const auto& group : option_groups_of(command)) {
            for (const auto& option : group.options) {
                auto name = long_name(option).substr(2);
                for (std::size_t i = 0; (i = name.find('-', i)) != std::string::npos; i += 2) {
                    name.insert(i, "\\");
                }
                EXPECT_THAT(page, HasSubstr("\\-\\-" + name)) << command.name;
            }
        }
    }
}

TEST(ManualPage, HasNoLineThatOnlyLooksLikeARequest) {
    constexpr std::array operands{Operand{"FILE", ".csv\n.json or 'x'"}};
    const Command odd{.name = "odd",
                      .summary = "Take a \\ apart",
                      .about = "'quoted' text\n.dotted",
                      .example = "  macadam odd a.csv",
                      .operands = operands,
                      .options = {},
                      .run = nullptr};
    const auto page = man_page_of(odd, "1");
    EXPECT_THAT(page, HasSubstr("Take a \\e apart"));
    EXPECT_THAT(page, HasSubstr("\n\\&'quoted' text\n\\&.dotted\n"));
    EXPECT_THAT(page, HasSubstr("\n\\&.csv\n\\&.json or 'x'\n"));
}

TEST(ManualPage, OfAllNamesEveryCommand) {
    const auto page = man_page_of_all("1");
    for (const auto& command : commands()) {
        EXPECT_THAT(page, HasSubstr(std::string{command.summary}));
    }
}

TEST(ValueHint, IsTheChoicesOfAnOptionOrTheSuffixesInItsHelp) {
    const auto theme = value_hint_of(option_of(render_command, "--theme"));
    EXPECT_EQ(theme.kind, ValueHint::Kind::words);
    EXPECT_THAT(theme.words, ElementsAre("light", "dark", "print"));
    const auto picture = value_hint_of(option_of(render_command, "-o,--output"));
    EXPECT_EQ(picture.kind, ValueHint::Kind::files);
    EXPECT_THAT(picture.suffixes, ElementsAre(".png", ".tif", ".pdf"));
    EXPECT_THAT(value_hint_of(render_command.operands.front()).suffixes, ElementsAre(".gpkg"));
    EXPECT_EQ(value_hint_of(option_of(render_command, "--title")).kind, ValueHint::Kind::none);
    EXPECT_EQ(value_hint_of(option_of(import_command, "--vehicles")).kind,
              ValueHint::Kind::folders);
}

TEST(ValueHint, OffersAllFilesWhereTheHelpSaysThatThereAreOthers) {
    EXPECT_THAT(value_hint_of(option_of(init_command, "--network")).suffixes, IsEmpty());
    EXPECT_THAT(value_hint_of(import_command.operands.back()).suffixes, IsEmpty());
}

TEST(BashCompletion, OffersCommandsOptionsChoicesAndFilesBySuffix) {
    EXPECT_EQ(offered({"macadam", "rend"}), "render\n");
    EXPECT_EQ(offered({"macadam", "help", "rend"}), "render\n");
    EXPECT_EQ(offered({"macadam", "render", "--the"}), "--theme\n");
    EXPECT_EQ(offered({"macadam", "render", "roads.gpkg", "--theme", ""}), "light dark print\n");
    EXPECT_EQ(offered({"macadam", "render", "ro"}), "roads.gpkg\n");
    EXPECT_EQ(offered({"macadam", "render", "roads.gpkg", "-o", "ma"}), "map.png\n");
    EXPECT_EQ(offered({"macadam", "render", "roads.gpkg", "--title", "ma"}), "\n");
    EXPECT_EQ(offered({"macadam", "help", "conf"}), "config\n");
}

TEST(BashCompletion, CompletesValuesAfterAnEqualsSignWhichBashTakesForAWord) {
    EXPECT_EQ(offered({"macadam", "render", "--theme", "="}), "light dark print\n");
    EXPECT_EQ(offered({"macadam", "render", "--theme", "=", "da"}), "dark\n");
}

TEST(ManualPage, NamesTheFileAndVariablesOfDefaults) {
    const auto page = man_page_of(render_command, "1");
    EXPECT_THAT(page, HasSubstr(".SH FILES\n.TP\n.I $XDG_CONFIG_HOME/macadam/config.toml\n"));
    EXPECT_THAT(page, HasSubstr(".B MACADAM_LEFT_HAND\nDefault of \\-\\-left\\-hand.\n"));
    EXPECT_THAT(page, Not(HasSubstr("MACADAM_JOBS")));
    EXPECT_THAT(man_page_of_all("1"), HasSubstr("MACADAM_JOBS"));
}

TEST(Completions, NameEveryOptionAndNoEarlierSpelling) {
    const auto bash = bash_completion();
    const auto zsh = zsh_completion();
    const auto fish = fish_completion();
    for (const auto& command : commands()) {
        for (const auto& option : command.options) {
            const auto name = long_name(option);
            EXPECT_THAT(bash, HasSubstr(name));
            EXPECT_THAT(zsh, HasSubstr(name + "["));
            EXPECT_THAT(fish,
                        HasSubstr(fmt::format("__fish_seen_subcommand_from {}' ", command.name)));
            EXPECT_THAT(fish, HasSubstr("-l " + name.substr(2) + " "));
        }
    }
    EXPECT_THAT(zsh, HasSubstr("'--theme[light, dark or print.]:NAME:(light dark print)'"));
    EXPECT_THAT(fish, HasSubstr("-l theme -d 'light, dark or print.' -x -a 'light dark print'"));
    EXPECT_THAT(bash, Not(HasSubstr("valid-from/--from)")));
}

} // namespace
} // namespace macadam::testing
