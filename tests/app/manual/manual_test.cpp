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

#include <algorithm>

namespace macadam::testing {
namespace {

using ::testing::AllOf;
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
    ASSERT_GT(commands().size(), 20U);
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
    ASSERT_GT(commands().size(), 20U);
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

TEST(BashCompletion, OffersTheChoicesOfEveryOption) {
    std::size_t count = 0;
    for (const auto& command : commands()) {
        for (const auto& option : command.options) {
            const auto hint = value_hint_of(option);
            if (hint.kind == ValueHint::Kind::words) {
                ++count;
                EXPECT_EQ(offered({"macadam", std::string{command.name}, long_name(option), ""}),
                          fmt::format("{}\n", fmt::join(hint.words, " ")))
                    << command.name << long_name(option);
            }
        }
    }
    EXPECT_GT(count, 10U);
}

TEST(BashCompletion, OffersTheFilesOfEveryOptionBySuffix) {
    std::size_t count = 0;
    for (const auto& command : commands()) {
        for (const auto& option : command.options) {
            const auto suffixes = value_hint_of(option).suffixes;
            if (!suffixes.empty()) {
                ++count;
                const auto fits = [&](std::string_view file) {
                    return std::ranges::any_of(
                        suffixes, [&](const auto& suffix) { return file.ends_with(suffix); });
                };
                std::string expected;
                for (const std::string file : {"map.png", "map.txt", "roads.gpkg"}) {
                    expected += fits(file) ? (expected.empty() ? "" : " ") + file : "";
                }
                EXPECT_EQ(offered({"macadam", std::string{command.name}, long_name(option), ""}),
                          expected + "\n")
                    << command.name << long_name(option);
            }
        }
    }
    EXPECT_GT(count, 10U);
}

TEST(Completions, AreReadByTheirShellsWithoutAnError) {
    const auto folder = fresh_folder();
    write_file(folder / "macadam.bash", bash_completion());
    write_file(folder / "macadam.zsh", zsh_completion());
    write_file(folder / "macadam.fish", fish_completion());
    for (const std::string shell : {"bash -n", "zsh -n", "fish --no-execute"}) {
        const auto name = shell.substr(0, shell.find(' '));
        EXPECT_EQ(output_of(folder, shell + " " + (folder / ("macadam." + name)).string()), "");
    }
}

TEST(FishCompletion, OffersChoicesAndFilesBySuffixAlsoBelowTheHomeFolder) {
    const auto folder = fresh_folder();
    write_file(folder / "macadam.fish", fish_completion());
    for (const auto* const name : {"roads.gpkg", "my roads.gpkg", "roads.txt"}) {
        write_file(folder / name, "");
    }
    const auto offers = [&](const std::string& words) {
        return output_of(folder,
                         fmt::format("cd '{0}' && HOME='{0}' XDG_CONFIG_HOME='{0}' "
                                     "XDG_DATA_HOME='{0}' fish -c 'source macadam.fish; "
                                     "complete -C \"macadam {1}\" | cut -f 1'",
                                     folder.string(),
                                     words));
    };
    EXPECT_EQ(offers("rend"), "render\n");
    EXPECT_EQ(offers("render --theme "), "dark\nlight\nprint\n");
    EXPECT_EQ(offers("render roa"), "roads.gpkg\n");
    EXPECT_EQ(offers("render ~/roa"), "~/roads.gpkg\n");
    EXPECT_EQ(offers("render ~/my"), "~/my roads.gpkg\n");
    EXPECT_EQ(offers("render roads.gpkg --title roa"), "");
}

TEST(ZshCompletion, DescribesChoicesAndFilesBySuffixToArguments) {
    const auto folder = fresh_folder();
    write_file(folder / "_macadam", zsh_completion());
    write_file(folder / "script",
               "_arguments() { print -rl -- \"$@\" }\n_describe() { print -rl -- $names }\n"
               "CURRENT=$#\nwords=(\"$@\")\n. ./_macadam\n");
    const auto told = [&](const std::string& words) {
        return output_of(folder,
                         fmt::format("cd '{}' && zsh -f ./script {}", folder.string(), words));
    };
    EXPECT_THAT(told("macadam rend"), HasSubstr("render:"));
    EXPECT_THAT(told("macadam render x"),
                AllOf(HasSubstr("\n--theme[light, dark or print.]:NAME:(light dark print)\n"),
                      HasSubstr(":_files -g \"*(.png|.tif|.pdf)\"\n"),
                      HasSubstr(":_files -g \"*.gpkg\"")));
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
