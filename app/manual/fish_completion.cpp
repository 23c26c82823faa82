#include "app/manual/fish_completion.hpp"

#include "app/cli/commands.hpp"
#include "app/manual/value_hint.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

std::string in_quotes(std::string_view text) {
    std::string quoted;
    for (const char c : text) {
        if (c == '\'' || c == '\\') {
            quoted += '\\';
        }
        quoted += c == '\n' ? ' ' : c;
    }
    return fmt::format("'{}'", quoted);
}

/// Returns the words that make fish offer a value.
std::string action_of(const ValueHint& hint) {
    switch (hint.kind) {
    case ValueHint::Kind::words:
        return fmt::format("-x -a {}", in_quotes(fmt::format("{}", fmt::join(hint.words, " "))));
    case ValueHint::Kind::folders:
        return "-x -a '(__fish_complete_directories)'";
    case ValueHint::Kind::files:
        return hint.suffixes.empty()
                   ? "-r -F"
                   : fmt::format("-x -a '(__macadam_files {})'", fmt::join(hint.suffixes, " "));
    case ValueHint::Kind::none:
        break;
    }
    return "-x";
}

std::string line_of(const Command& command, const Option& option) {
    const auto comma = option.name.find(',');
    const auto short_name = comma == std::string_view::npos
                                ? ""
                                : fmt::format(" -s {}", option.name.substr(1, comma - 1));
    return fmt::format(
        "complete -c macadam -n '__fish_seen_subcommand_from {}'{} -l {} -d {}{}{}\n",
        command.name,
        short_name,
        long_name(option).substr(2),
        in_quotes(option.help),
        option.value.empty() ? "" : " ",
        option.value.empty() ? "" : action_of(value_hint_of(option)));
}

/// Returns the line that offers a command's operands.
std::string line_of(const Command& command, const Operand& operand) {
    const auto hint = value_hint_of(operand);
    if (hint.kind == ValueHint::Kind::none) {
        return "";
    }
    const auto action = action_of(hint);
    return fmt::format("complete -c macadam -n '__fish_seen_subcommand_from {}' {}\n",
                       command.name,
                       action.starts_with("-r") || action.starts_with("-x") ? action.substr(3)
                                                                            : action);
}

} // namespace

std::string fish_completion() {
    std::string text = "# fish completion of macadam, made from its table of commands\n\n"
                       "# Files of these suffixes, and folders.\n"
                       "function __macadam_files\n"
                       "    set -l token (commandline -ct)\n"
                       "    set -l path (string replace -r '^~(?=/)' -- $HOME \"$token\")\n"
                       "    __fish_complete_directories\n"
                       "    for suffix in $argv\n"
                       "        for file in $path*$suffix\n"
                       "            test -d $file; and continue\n"
                       "            string replace -- \"$path\" \"$token\" $file\n"
                       "        end\n"
                       "    end\n"
                       "end\n\n"
                       "complete -c macadam -f\n";
    std::string names;
    for (const auto& command : commands()) {
        names += fmt::format("{} ", command.name);
        text += fmt::format("complete -c macadam -n __fish_use_subcommand -a {} -d {}\n",
                            command.name,
                            in_quotes(command.summary));
    }
    text +=
        fmt::format("complete -c macadam -n __fish_use_subcommand -a help -d 'Show the help of "
                    "a command'\n"
                    "complete -c macadam -n '__fish_seen_subcommand_from help' -a '{} config'\n",
                    names);
    for (const auto& command : commands()) {
        for (const auto& group : option_groups_of(command)) {
            for (const auto& option : group.options) {
                text += line_of(command, option);
            }
        }
        for (const auto& operand : command.operands) {
            text += line_of(command, operand);
        }
    }
    return text;
}

} // namespace macadam
