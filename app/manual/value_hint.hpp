#pragma once

#include "app/cli/arguments.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Completion that a shell offers for the value of an option or an operand.
struct ValueHint {
    enum class Kind { none, words, folders, files };
    Kind kind = Kind::none;
    std::vector<std::string_view> words; ///< of Kind::words
    std::vector<std::string> suffixes;   ///< of Kind::files: ".gpkg", ...; empty = all files
};

/// Derives the hint from the table: choices are words; values named FILE, DIR, STORE, ... are
/// files, of the suffixes that the help names unless it says that there are others.
ValueHint value_hint_of(const Option& option);
ValueHint value_hint_of(const Operand& operand);

} // namespace macadam
