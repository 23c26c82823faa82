#include "app/manual/zsh_completion.hpp"

#include "app/cli/commands.hpp"
#include "app/manual/value_hint.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

/// Escapes a text for a specification of _arguments within single quotes.
std::string in_quotes(std::string_view text) {
    std::string quoted;
    for (const char c : text) {
        if (c == '\'') {
            quoted += "'\\''";
        } else if (c == '[' || c == ']' || c == ':' || c == '\\') {
            quoted += '\\';
            quoted += c;
        } else {
            quoted += c == '\n' ? ' ' : c;
        }
    }
    return quoted;
}

std::string action_of(const ValueHint& hint) {
    switch (hint.kind) {
    case ValueHint::Kind::words:
        return fmt::format("({})", fmt::join(hint.words, " "));
    case ValueHint::Kind::folders:
        return "_files -/";
    case ValueHint::Kind::files:
        return hint.suffixes.empty() ? "_files"
               : hint.suffixes.size() == 1
                   ? fmt::format("_files -g \"*{}\"", hint.suffixes.front())
                   : fmt::format("_files -g \"*({})\"", fmt::join(hint.suffixes, "|"));
    case ValueHint::Kind::none:
        break;
    }
    return " ";
}

/// Returns the specifications of an option, one for each of its names.
std::string specification_of(const Option& option) {
    const auto comma = option.name.find(',');
    const auto exclusive =
        comma == std::string_view::npos
            ? ""
            : fmt::format("({} {})", option.name.substr(0, comma), option.name.substr(comma + 1));
    std::string value;
    if (!option.value.empty()) {
        value = fmt::format("{}{}:{}",
                            option.value.starts_with('[') ? "::" : ":",
                            in_quotes(option.value),
                            action_of(value_hint_of(option)));
    }
    std::string lines;
    for (std::size_t begin = 0; begin < option.name.size();) {
        const auto end = std::min(option.name.find(',', begin), option.name.size());
        lines += fmt::format("            '{}{}{}[{}]{}' \\\n",
                             option.many || option.is_repeatable ? "*" : exclusive,
                             option.name.substr(begin, end - begin),
                             "",
                             in_quotes(option.help),
                             value);
        begin = end + 1;
    }
    return lines;
}

std::string case_of(const Command& command) {
    auto text = fmt::format("    {})\n        _arguments \\\n"
                            "            '(- *)--help[Show the usual options]' \\\n"
                            "            '(- *)--help-all[Show all options]' \\\n",
                            command.name);
    for (const auto& group : option_groups_of(command)) {
        for (const auto& option : group.options) {
            text += specification_of(option);
        }
    }
    for (const auto& operand : command.operands) {
        text += fmt::format("            '{}:{}:{}' \\\n",
                            operand.many       ? "*"
                            : operand.optional ? ":"
                                               : "",
                            in_quotes(operand.name),
                            action_of(value_hint_of(operand)));
    }
    return text + "            && return 0\n        ;;\n";
}

} // namespace

std::string zsh_completion() {
    std::string names;
    std::string cases;
    for (const auto& command : commands()) {
        names += fmt::format("        '{}:{}'\n", command.name, in_quotes(command.summary));
        cases += case_of(command);
    }
    return fmt::format("#compdef macadam\n"
                       "# zsh completion of macadam, made from its table of commands\n\n"
                       "_macadam() {{\n"
                       "    local -a names=(\n{}"
                       "        'help:Show the help of a command'\n"
                       "    )\n"
                       "    if (( CURRENT == 2 )); then\n"
                       "        _describe command names\n"
                       "        return\n"
                       "    fi\n"
                       "    shift words\n"
                       "    (( CURRENT-- ))\n"
                       "    case $words[1] in\n"
                       "    help) names+=('config:Show defaults of options'); "
                       "_describe command names ;;\n{}"
                       "    esac\n"
                       "}}\n\n"
                       "_macadam \"$@\"\n",
                       names,
                       cases);
}

} // namespace macadam
