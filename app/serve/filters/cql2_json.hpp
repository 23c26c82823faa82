#pragma once

#include "app/serve/filters/cql2_expression.hpp"

#include <string_view>

namespace macadam {

/// Parses a filter in CQL2 JSON, of the same extent as CQL2 text (parse_cql2_text).
///
/// Source: OGC 21-065r2, annex A (schema).
/// \throws Cql2Error  for other text, and beyond max_cql2_bytes or max_cql2_depth.
Cql2Expression parse_cql2_json(std::string_view text);

} // namespace macadam
