#include "app/manual/man_page.hpp"

#include "app/config/user_defaults.hpp"

#include <fmt/format.h>

#include <cctype>
#include <vector>

namespace macadam {
namespace {

constexpr std::string_view exit_status = ".SH EXIT STATUS\n"
                                         "0 success, 1 failure, 2 usage error.\n";

/// Escapes a text for roff: backslashes, hyphens of options, and lines that begin like requests.
std::string in_roff(std::string_view text) {
    std::string roff;
    bool begins = true;
    for (const char c : text) {
        if (begins && (c == '.' || c == '\'')) {
            roff += "\\&";
        }
        roff += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
        begins = c == '\n';
    }
    return roff;
}

std::string in_capitals(std::string_view text) {
    std::string capitals;
    for (const char c : text) {
        capitals += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
    return capitals;
}

std::string title(std::string_view name, std::string_view summary, std::string_view version) {
    return fmt::format(".TH {} 1 \"\" \"Macadam {}\" \"Macadam manual\"\n.SH NAME\n{} \\- {}\n",
                       in_roff(in_capitals(name)),
                       version,
                       in_roff(name),
                       in_roff(summary));
}

/// Names the files and variables with defaults of options.
/// \param options  those whose defaults users may set
std::string defaults_of(const std::vector<Option>& options) {
    std::string roff = ".SH FILES\n.TP\n.I $XDG_CONFIG_HOME/macadam/config.toml\nDefaults of "
                       "options, by default in \\(ti/.config/macadam/config.toml; see "
                       "\\fBmacadam help config\\fP.\n"
                       ".TP\n.I macadam.toml\nBeside a database: unit, language, theme and "
                       "[colours] of its maps and reports.\n"
                       ".SH ENVIRONMENT\n";
    for (const auto& option : options) {
        roff += fmt::format(".TP\n.B {}\nDefault of {}.\n",
                            in_roff(variable_of(preference_key(option))),
                            in_roff(long_name(option)));
    }
    return roff + ".TP\n.B NO_COLOR\nNo colour, if it is not empty.\n";
}

std::string example_of(std::string_view lines) {
    return fmt::format(".SH EXAMPLE\n.EX\n{}\n.EE\n", in_roff(lines));
}

std::string described(const Option& option) {
    auto text = in_roff(option.help);
    if (!option.fallback.empty()) {
        text += fmt::format("\nDefault: {}.", in_roff(option.fallback));
    }
    return fmt::format(".TP\n.B {}\n{}\n", in_roff(term_of(option)), text);
}

} // namespace

std::string man_page_of_all(std::string_view version) {
    auto page = title("macadam", "road roughness maps from the sensors of ordinary cars", version);
    page += ".SH SYNOPSIS\n.B macadam\n.I COMMAND\n\\&...\n.br\n.B macadam help\n.I COMMAND\n"
            ".SH DESCRIPTION\n"
            "Estimates the International Roughness Index (IRI) of roads from trip logs, fuses the "
            "passes of all cars\nin a road database, one .gpkg file that "
            "\\fBmacadam init\\fP makes, and draws and exports the result.\n"
            ".SH COMMANDS\n";
    for (const auto& command : commands()) {
        page += fmt::format(
            ".TP\n.BR macadam\\-{} (1)\n{}.\n", in_roff(command.name), in_roff(command.summary));
    }
    page += exit_status;
    std::vector<Option> options;
    for (const auto& [key, preference] : preferences()) {
        options.push_back(preference.option);
    }
    page += defaults_of(options);
    return page + example_of("  macadam init roads.gpkg --network town.osm.pbf\n"
                             "  macadam import roads.gpkg trips/\n"
                             "  macadam render roads.gpkg -o map.png");
}

std::string man_page_of(const Command& command, std::string_view version) {
    auto page = title(fmt::format("macadam-{}", command.name), command.summary, version);
    page += fmt::format(".SH SYNOPSIS\n{}\n.SH DESCRIPTION\n{}\n",
                        in_roff(usage_of(command)),
                        in_roff(command.about));
    for (const auto& operand : command.operands) {
        page += fmt::format(".TP\n.I {}\n{}\n", in_roff(operand.name), in_roff(operand.help));
    }
    for (const auto& [name, options] : option_groups_of(command)) {
        page += fmt::format(".SH {}\n", in_capitals(name));
        for (const auto& option : options) {
            page += described(option);
        }
    }
    page += example_of(command.example);
    page += exit_status;
    auto options = options_of(command);
    std::erase_if(options, [](const Option& option) { return !option.is_preference; });
    page += defaults_of(options);
    return page + ".SH SEE ALSO\n.BR macadam (1)\n";
}

} // namespace macadam
