#pragma once

#include <string>
#include <string_view>

namespace macadam {

/// UTF-8 text such that texts that differ in upper and lower case alone become one: "STRASSE" and
/// "Straße", "ΟΔΟΣ" and "οδός" but for its accent, "УЛИЦА" and "улица". Accents stay; bytes that
/// are no UTF-8 stay as they are. The same on every machine, whatever its language.
///
/// Covers the Latin, Greek, Cyrillic, Armenian and Georgian letters of Unicode's CaseFolding.txt
/// (statuses C and F), as far as they follow a rule; others have no case in names of roads.
std::string case_folded(std::string_view text);

} // namespace macadam
