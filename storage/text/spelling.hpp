#pragma once

#include <span>
#include <string>
#include <string_view>

namespace macadam {

/// Returns the known word nearest to a misspelled one: at most one edit away (insertion, deletion,
/// substitution, transposition), two for words longer than six characters; "" if there is none.
std::string nearest_word(std::string_view misspelled, std::span<const std::string> known);

/// Returns "; did you mean WORD?", or "" if no known word is near.
std::string suggestion(std::string_view misspelled, std::span<const std::string> known);

} // namespace macadam
