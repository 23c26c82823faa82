#pragma once

#include <string>
#include <string_view>

namespace macadam {

/// Returns the style sheet of a report, for narrow and wide, light and dark screens, and for paper.
std::string report_style();

/// Returns the script of a page, which works without it: folds sections on phones, sorts tables by
/// a click on a column's heading, and offers each table as a CSV file. It requests nothing.
std::string_view page_script();

/// Base64 of the script's SHA-256, by which the page's content security policy lets it run.
inline constexpr std::string_view page_script_sha256 =
    "WwdWJ5QyaA1daiAVV2tD8QyvMJqvlH/tEp5NLxKicsA=";

} // namespace macadam
