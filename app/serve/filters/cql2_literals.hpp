#pragma once

#include "app/serve/filters/cql2_expression.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace macadam {

/// Parses "2026-05-01", or a time such as "2026-05-01T06:00:00Z".
/// \throws Cql2Error  for other text.
Cql2Instant parse_cql2_instant(std::string_view text);

/// Parses an instant, or ".." for an open end.
/// \throws Cql2Error  for other text.
Cql2Border parse_cql2_border(std::string_view text);

/// Name of an operator in CQL2 JSON by a word of any case: "T_FINISHEDBY" is "t_finishedBy", as is
/// "s_intersects", "casei"; `std::nullopt` for a word that is none.
std::optional<std::string_view> cql2_function(std::string_view word);

/// Checks that a geometry has as many positions as its kind needs.
/// \throws Cql2Error  if it has too few, or a ring that is not closed.
void expect_whole(const Cql2Geometry& geometry);

} // namespace macadam
