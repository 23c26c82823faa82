#pragma once

#include "app/cli/commands.hpp"
#include "storage/tables/toml.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Preference of users: an option whose default they may set (`preference` in the tables).
struct Preference {
    Option option;                          ///< of the first command that has it
    std::vector<std::string_view> choices;  ///< of all commands that have it; empty: any value
    std::vector<std::string_view> commands; ///< that have it; empty: all commands
};

/// Returns the preferences by key: "left_hand" for --left-hand.
const std::map<std::string, Preference, std::less<>>& preferences();

/// Returns "left_hand" for --left-hand.
std::string preference_key(const Option& option);

/// Returns "MACADAM_LEFT_HAND" for the key "left_hand".
std::string variable_of(std::string_view key);

/// Returns $XDG_CONFIG_HOME/macadam/config.toml, else ~/.config/macadam/config.toml;
/// `std::nullopt` without a home folder. XDG_CONFIG_HOME must be absolute, as its specification
/// demands.
std::optional<std::filesystem::path> config_file();

/// Reads the defaults of a command from a configuration file: a key for each preference, for all
/// commands that have the option, and tables named like commands, such as [render], for these
/// alone.
///
/// \param folder  in which relative paths of the file start
/// \returns       those of the command's own table first
/// \throws InputError  "file:line: ..." for an unknown key or an invalid value of any command
std::vector<Default> config_defaults(const TomlTable& config,
                                     const std::filesystem::path& folder,
                                     const Command& command);

/// Returns the user's defaults for a command, one an option: variables MACADAM_* precede the
/// configuration file.
/// \throws UsageError  for a variable or a key that is misspelled or has an invalid value.
std::vector<Default> user_defaults(const Command& command);

} // namespace macadam
