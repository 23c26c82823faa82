#pragma once

#include <string>
#include <string_view>

namespace macadam {

/// Folds the case of UTF-8 text, so that texts which differ only in upper and lower case compare
/// equal: "STRASSE" and "Straße", "ΟΔΟΣ" and "οδός" except for its accent, "УЛИЦА" and "улица".
/// Accents and invalid UTF-8 bytes are kept. The result does not depend on the locale.
///
/// Covers the Latin, Greek, Cyrillic, Armenian and Georgian letters of Unicode's CaseFolding.txt
/// (statuses C and F) as far as they follow a rule; the other scripts of road names have no case.
std::string case_folded(std::string_view text);

} // namespace macadam
