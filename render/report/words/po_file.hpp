#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Entry of a gettext catalogue.
struct PoEntry {
    std::size_t line = 0; ///< of its msgid, from 1
    std::string context;
    std::string id;
    std::string plural_id;            ///< "" = none
    std::vector<std::string> strings; ///< translations: one, or one per plural form; "" = none
    bool fuzzy = false;               ///< marked as to be checked by a translator
};

/// Parses a .po or .pot file: entries in order, of which the first may be the header (an empty id).
/// Obsolete entries (#~) are skipped.
///
/// Source of the format: GNU gettext manual 0.21, section 3.
///
/// \param name  of the file, for messages
/// \throws InputError  if it is not such a file: other syntax, bytes that are not UTF-8, control
///                     characters, or more than 4 MB.
std::vector<PoEntry> parse_po(std::string_view text, std::string_view name);

} // namespace macadam
