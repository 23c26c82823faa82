#pragma once

#include <string_view>

namespace macadam {

/// Returns what a column of segments, sections, worst sections or events means, whatever its unit:
/// `iri` and `iri_in_per_mi` mean the same. "" for other columns. docs/reference/exports.md and
/// sections.md tell more.
std::string_view meaning_of_column(std::string_view name);

} // namespace macadam
