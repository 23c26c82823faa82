#pragma once

#include "app/serve/filters/cql2_expression.hpp"

#include <string_view>

namespace macadam {

/// Parses a filter in CQL2 text by recursive descent.
///
/// Read are comparisons, LIKE, BETWEEN, IN, IS NULL, CASEI, arithmetic, spatial and temporal
/// functions; arrays, ACCENTI and functions of an implementation are not.
///
/// Source: OGC 21-065r2, annex B (BNF); ENVELOPE of its drafts is read as BBOX.
/// \throws Cql2Error  with the place for other text, and beyond max_cql2_bytes or max_cql2_depth.
Cql2Expression parse_cql2_text(std::string_view text);

} // namespace macadam
