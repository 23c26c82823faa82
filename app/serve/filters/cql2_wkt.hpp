#pragma once

#include "app/serve/filters/cql2_expression.hpp"
#include "app/serve/filters/cql2_words.hpp"

#include <string_view>

namespace macadam {

/// Tests for a word that begins a geometry in CQL2 text: "POINT", "BBOX".
bool is_cql2_geometry(std::string_view word);

/// Parses what follows that word: WKT, or the numbers of BBOX. Heights are left out.
/// \throws Cql2Error  for other text, and for a geometry that is not whole.
Cql2Geometry parse_cql2_wkt(std::string_view word, Cql2Words& words);

} // namespace macadam
