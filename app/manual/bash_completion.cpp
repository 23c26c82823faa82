#include "app/manual/bash_completion.hpp"

#include "app/cli/commands.hpp"
#include "app/manual/value_hint.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace macadam {
namespace {

constexpr std::string_view head = R"(# bash completion of macadam, made from its table of commands

# $current, here and below, is the word to complete, a local variable of _macadam.
_macadam_words() {
    COMPREPLY=($(compgen -W "$*" -- "$current"))
}

_macadam_folders() {
    compopt -o filenames
    mapfile -t COMPREPLY < <(compgen -d -- "$current")
}

# Files of these suffixes, or all files, and folders.
_macadam_files() {
    local suffix
    compopt -o filenames
    mapfile -t COMPREPLY < <(
        [ $# -gt 0 ] || compgen -f -- "$current"
        [ $# -eq 0 ] || compgen -d -- "$current"
        for suffix in "$@"; do
            compgen -f -X "!*$suffix" -- "$current"
        done | sort -u
    )
}

)";

std::string action_of(const ValueHint& hint) {
    switch (hint.kind) {
    case ValueHint::Kind::words:
        return fmt::format("_macadam_words {}", fmt::join(hint.words, " "));
    case ValueHint::Kind::folders:
        return "_macadam_folders";
    case ValueHint::Kind::files:
        return fmt::format("_macadam_files {}", fmt::join(hint.suffixes, " "));
    case ValueHint::Kind::none:
        break;
    }
    return "return";
}

/// Returns the cases of the word after an option: "render/--theme) ...".
std::string values_of(const Command& command) {
    std::string cases;
    for (const auto& option : command.options) {
        if (option.value.empty()) {
            continue;
        }
        std::string words = fmt::format("{}/{}", command.name, option.name);
        if (const auto comma = words.find(','); comma != std::string::npos) {
            words.replace(comma, 1, fmt::format(" | {}/", command.name));
        }
        cases += fmt::format("    {}) {}; return ;;\n", words, action_of(value_hint_of(option)));
    }
    return cases;
}

std::string words_of(const Command& command) {
    std::string names = "--help --help-all";
    for (const auto& group : option_groups_of(command)) {
        for (const auto& option : group.options) {
            auto name = std::string{option.name};
            std::ranges::replace(name, ',', ' ');
            names += " " + name;
        }
    }
    ValueHint operand;
    for (const auto& each : command.operands) { // the last one of most use: later words are its
        if (const auto hint = value_hint_of(each); hint.kind != ValueHint::Kind::none) {
            operand = hint;
        }
    }
    return fmt::format("    {})\n"
                       "        case $current in\n"
                       "        -*) _macadam_words {} ;;\n"
                       "        *) {} ;;\n"
                       "        esac ;;\n",
                       command.name,
                       names,
                       action_of(operand));
}

} // namespace

std::string bash_completion() {
    std::string names;
    std::string values;
    std::string words;
    for (const auto& command : commands()) {
        names += fmt::format("{} ", command.name);
        values += values_of(command);
        words += words_of(command);
    }
    return fmt::format("{}_macadam() {{\n"
                       "    local current=${{COMP_WORDS[COMP_CWORD]}} "
                       "before=${{COMP_WORDS[COMP_CWORD - 1]}} command=${{COMP_WORDS[1]}}\n"
                       "    if [ \"$current\" = = ]; then # bash splits --format=csv\n"
                       "        current=\n"
                       "    elif [ \"$before\" = = ]; then\n"
                       "        before=${{COMP_WORDS[COMP_CWORD - 2]}}\n"
                       "    fi\n"
                       "    if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
                       "        _macadam_words {}help --help --version\n"
                       "        return\n"
                       "    fi\n"
                       "    case $command/$before in\n"
                       "    help/help) _macadam_words {}config; return ;;\n{}"
                       "    esac\n"
                       "    case $command in\n{}"
                       "    esac\n"
                       "}}\n\n"
                       "complete -F _macadam macadam\n",
                       head,
                       names,
                       names,
                       values,
                       words);
}

} // namespace macadam
