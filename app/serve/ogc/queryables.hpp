#pragma once

#include "app/serve/features/feature.hpp"

#include <span>
#include <string>
#include <string_view>

namespace macadam {

/// Properties that a filter may use, as JSON Schema 2020-12 (OGC API - Features 3, 6.2).
/// \param address   of the page itself
/// \param geometry  format of the geometry, "geometry-point"; "" = there is none
std::string queryables_text(std::string_view title,
                            std::string_view address,
                            std::span<const FeatureColumn> columns,
                            std::string_view geometry);

/// JSON Schema of one column's values as JSON has them; unknown ones are null.
std::string column_schema(const ColumnType& type);

} // namespace macadam
