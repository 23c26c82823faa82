#include "app/config/config_help.hpp"

#include "app/config/user_defaults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace macadam {
namespace {

constexpr std::string_view rules = "Defaults of options, in order of rank:\n"
                                   "  1. the command line\n"
                                   "  2. variables, such as MACADAM_UNITS=us\n"
                                   "  3. the configuration file, a TOML file\n"
                                   "  4. macadam.toml beside a database: unit, language, theme and "
                                   "[colours] of maps and reports\n";

constexpr std::string_view example = "\nexample of a configuration file\n"
                                     "  units = \"us\"\n"
                                     "  jobs = 4\n"
                                     "  vehicles = \"cars\"     # relative to the file\n"
                                     "  [render]              # for one command\n"
                                     "  theme = \"dark\"\n";

std::string file_text() {
    const auto file = config_file();
    std::error_code unreachable;
    return !file ? "none: neither HOME nor XDG_CONFIG_HOME is set"
                 : fmt::format("{}{}",
                               file->string(),
                               std::filesystem::exists(*file, unreachable) ? "" : " (not there)");
}

std::string preferences_text() {
    auto text = fmt::format("\n{:<12}{:<22}{}\n", "key", "variable", "values; commands");
    for (const auto& [key, preference] : preferences()) {
        const auto& option = preference.option;
        if (key != preference_key(option)) {
            continue; // an earlier spelling
        }
        text += fmt::format(
            "{:<12}{:<22}{}; {}\n",
            key,
            variable_of(key),
            option.value.empty()         ? "true, false"
            : preference.choices.empty() ? std::string{option.value}
                                         : fmt::format("{}", fmt::join(preference.choices, ", ")),
            preference.commands.empty() ? "all"
                                        : fmt::format("{}", fmt::join(preference.commands, ", ")));
    }
    return text;
}

/// Lists each default in force once, with the commands to which it applies.
std::string values_text() {
    struct Use {
        Default value;
        std::vector<std::string_view> commands;
    };
    std::vector<Use> uses;
    for (const auto& command : commands()) {
        for (const auto& each : user_defaults(command)) {
            auto found = std::ranges::find_if(uses, [&](const Use& use) {
                return use.value.option == each.option && use.value.source == each.source;
            });
            if (found == uses.end()) {
                found = uses.insert(uses.end(), {each, {}});
            }
            found->commands.push_back(command.name);
        }
    }
    std::string text = "\nin force\n";
    for (const auto& [value, names] : uses) {
        text += fmt::format("  {} {}  ({})  in {}\n",
                            value.option,
                            value.value,
                            value.source,
                            names.size() == commands().size()
                                ? "all commands"
                                : fmt::format("{}", fmt::join(names, ", ")));
    }
    return uses.empty() ? text + "  built-in defaults only\n" : text;
}

std::string values_or_error() {
    try {
        return values_text();
    } catch (const UsageError& error) {
        return fmt::format("\nerror\n  {}\n", error.what());
    }
}

} // namespace

std::string config_help() {
    return fmt::format("{}\nconfiguration file\n  {}\n{}{}{}",
                       rules,
                       file_text(),
                       values_or_error(),
                       preferences_text(),
                       example);
}

} // namespace macadam
