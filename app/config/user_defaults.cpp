#include "app/config/user_defaults.hpp"

#include "estimator/common/ascii.hpp"
#include "estimator/common/error.hpp"
#include "storage/text/spelling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <iterator>

#include <unistd.h>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view variable_prefix = "MACADAM_";
constexpr std::int64_t max_integer = 1'000'000'000;

/// Returns a variable of the environment; "" if it is not set.
std::string variable(const std::string& name) {
    const char* const value = std::getenv(name.c_str()); // NOLINT(concurrency-mt-unsafe)
    return value == nullptr ? "" : value;
}

void add_choices(Preference& preference, const Option& option) {
    for (const auto choice : choices_in(option.choices)) {
        if (std::ranges::find(preference.choices, choice) == preference.choices.end()) {
            preference.choices.push_back(choice);
        }
    }
}

/// Returns the key of an earlier spelling; "" if there is none.
std::string former_key(const Option& option) {
    return option.former.empty() || option.former_is_refused
               ? std::string{}
               : preference_key({option.former, option.value, option.help});
}

std::map<std::string, Preference, std::less<>> collect_preferences() {
    std::map<std::string, Preference, std::less<>> found;
    for (const auto& command : commands()) {
        for (const auto& option : options_of(command)) {
            if (option.is_preference) {
                auto& preference =
                    found.try_emplace(preference_key(option), Preference{option, {}, {}})
                        .first->second;
                add_choices(preference, option);
                preference.commands.push_back(command.name);
            }
        }
    }
    for (auto& [key, preference] : found) {
        if (preference.commands.size() == commands().size()) {
            preference.commands.clear();
        }
    }
    auto with_former = found;
    for (const auto& [key, preference] : found) {
        if (const auto former = former_key(preference.option); !former.empty()) {
            with_former.emplace(former, preference);
        }
    }
    return with_former;
}

bool is_path(const Option& option) {
    return option.value == "FILE" || option.value == "DIR";
}

/// Parses the value of a flag; `std::nullopt` for any other word.
std::optional<bool> truth_of(std::string_view word) {
    const auto lower = in_lower_case(word);
    if (lower == "1" || lower == "yes" || lower == "true" || lower == "on") {
        return true;
    }
    if (lower == "0" || lower == "no" || lower == "false" || lower == "off") {
        return false;
    }
    return {};
}

/// Returns the value of a key as a word of the command line; "no" for a flag that is off.
std::string word_of(const TomlTable& table, const std::string& key, const Preference& preference) {
    if (preference.option.value.empty()) {
        return table.flag(key) ? "yes" : "no";
    }
    if (preference.option.value == "N") {
        return fmt::format("{}", table.integer(key, 1, max_integer));
    }
    const auto text = table.text(key);
    if (preference.choices.empty()) {
        return text;
    }
    const auto choice = choice_among(preference.choices, text);
    if (!choice) {
        table.refuse(key, fmt::format("{}", fmt::join(preference.choices, " or ")));
    }
    return *choice;
}

[[noreturn]] void refuse_unknown_key(const TomlTable& table,
                                     std::string_view key,
                                     const std::vector<std::string>& known) {
    const auto nearest = suggestion(key, known);
    throw InputError{fmt::format("{}: '{}' is no option with a default{}",
                                 table.where(key),
                                 key,
                                 nearest.empty() ? "; see 'macadam help config'" : nearest)};
}

/// Reads the preferences of a table; checks those of all commands.
std::vector<Default>
defaults_in(const TomlTable& table, const fs::path& folder, const std::vector<std::string>& keys) {
    std::vector<Default> defaults;
    for (const auto& key : keys) {
        const auto& preference = preferences().find(key)->second;
        auto word = word_of(table, key, preference);
        if (is_path(preference.option)) {
            word = (folder / word).lexically_normal().string();
        }
        defaults.push_back({long_name(preference.option), std::move(word), table.where(key)});
    }
    return defaults;
}

/// Checks the keys of [render].
std::vector<std::string> keys_of_command(const TomlTable& table, const Command& command) {
    std::vector<std::string> known;
    for (const auto& option : options_of(command)) {
        if (option.is_preference) {
            known.push_back(preference_key(option));
            if (auto former = former_key(option); !former.empty()) {
                known.push_back(std::move(former));
            }
        }
    }
    const auto keys = table.keys();
    for (const auto& key : keys) {
        if (std::ranges::find(known, key) == known.end()) {
            refuse_unknown_key(table, key, known);
        }
    }
    return keys;
}

std::vector<std::string> known_keys() {
    std::vector<std::string> known;
    for (const auto& [key, preference] : preferences()) {
        known.push_back(key);
    }
    for (const auto& command : commands()) {
        known.emplace_back(command.name);
    }
    return known;
}

/// Rejects a variable that is probably a misspelled preference. Others may be of other programs.
void expect_spelled(std::span<const std::string> known) {
    for (auto** variable = environ; *variable != nullptr; ++variable) {
        const std::string_view text{*variable};
        const auto name = text.substr(0, text.find('='));
        if (name.starts_with(variable_prefix) && std::ranges::find(known, name) == known.end()) {
            if (const auto nearest = suggestion(name, known); !nearest.empty()) {
                throw UsageError{fmt::format("unknown variable {}{}", name, nearest)};
            }
        }
    }
}

std::string word_of_variable(const std::string& name, const Preference& preference) {
    const auto value = variable(name);
    if (preference.option.value.empty()) {
        const auto truth = truth_of(value);
        if (!truth) {
            throw UsageError{fmt::format("{} is '{}', expected yes or no", name, value)};
        }
        return *truth ? "yes" : "no";
    }
    if (preference.choices.empty()) {
        return value;
    }
    const auto choice = choice_among(preference.choices, value);
    if (!choice) {
        throw UsageError{fmt::format(
            "{} is '{}', expected {}", name, value, fmt::join(preference.choices, " or "))};
    }
    return *choice;
}

std::vector<Default> defaults_of_variables() {
    std::vector<Default> defaults;
    std::vector<std::string> names;
    for (const auto& [key, preference] : preferences()) {
        names.push_back(variable_of(key));
        if (!variable(names.back()).empty()) {
            defaults.push_back({long_name(preference.option),
                                word_of_variable(names.back(), preference),
                                names.back()});
        }
    }
    expect_spelled(names);
    return defaults;
}

/// Keeps the first default of each option, and the first of --quiet and --verbose, which exclude
/// each other; drops flags that are off, and options that are no preference of the command: --unit
/// of a survey that is read.
std::vector<Default> in_force(const std::vector<Default>& ranked, const Command& command) {
    const auto subject = [](const std::string& option) {
        return option == "--quiet" ? "--verbose" : option;
    };
    std::vector<Default> first;
    for (const auto& each : ranked) {
        const bool is_settled = std::ranges::any_of(first, [&](const Default& earlier) {
            return subject(earlier.option) == subject(each.option) &&
                   (earlier.option == each.option || earlier.value == "yes");
        });
        if (!is_settled) {
            first.push_back(each);
        }
    }
    const auto options = options_of(command);
    std::erase_if(first, [&](const Default& each) {
        const bool is_preferred = std::ranges::any_of(options, [&](const Option& option) {
            return option.is_preference && long_name(option) == each.option;
        });
        return !is_preferred || each.value == "no";
    });
    return first;
}

} // namespace

const std::map<std::string, Preference, std::less<>>& preferences() {
    static const auto all = collect_preferences();
    return all;
}

std::string preference_key(const Option& option) {
    auto key = long_name(option).substr(2);
    std::ranges::replace(key, '-', '_');
    return key;
}

std::string variable_of(std::string_view key) {
    std::string name{variable_prefix};
    std::ranges::transform(key, std::back_inserter(name), [](char c) {
        return static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    });
    return name;
}

std::optional<fs::path> config_file() {
    const fs::path place = "macadam/config.toml";
    if (const fs::path xdg = variable("XDG_CONFIG_HOME"); xdg.is_absolute()) {
        return xdg / place;
    }
    const fs::path home = variable("HOME");
    return home.is_absolute() ? std::optional{home / ".config" / place} : std::nullopt;
}

std::vector<Default>
config_defaults(const TomlTable& config, const fs::path& folder, const Command& command) {
    std::vector<Default> own;
    std::vector<std::string> general;
    for (const auto& key : config.keys()) {
        const auto* const other = command_named(key);
        const bool is_preference = preferences().contains(key) && !config.is_table(key);
        if (other != nullptr && !is_preference) {
            const auto table = config.table(key);
            auto defaults = defaults_in(*table, folder, keys_of_command(*table, *other));
            if (other->name == command.name) {
                own = std::move(defaults);
            }
        } else if (is_preference) {
            general.push_back(key);
        } else {
            refuse_unknown_key(config, key, known_keys());
        }
    }
    std::ranges::move(defaults_in(config, folder, general), std::back_inserter(own));
    return own;
}

std::vector<Default> user_defaults(const Command& command) {
    auto ranked = defaults_of_variables();
    const auto file = config_file();
    std::error_code unreachable;
    if (file && fs::exists(*file, unreachable)) {
        try {
            const auto config = read_toml(*file, "a configuration file");
            std::ranges::move(config_defaults(config, file->parent_path(), command),
                              std::back_inserter(ranked));
        } catch (const InputError& error) {
            throw UsageError{error.what()};
        }
    }
    return in_force(ranked, command);
}

} // namespace macadam
