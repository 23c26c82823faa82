#pragma once

#include "app/serve/features/coordinate_reference.hpp"
#include "app/serve/features/feature.hpp"
#include "app/serve/filters/cql2_expression.hpp"
#include "estimator/common/geo.hpp"

#include <optional>
#include <span>
#include <string_view>

namespace macadam {

/// Name of the geometry among the properties that a filter may use.
inline constexpr std::string_view geometry_property = "geometry";

/// Tests whether a filter may use a column.
bool is_queryable(const FeatureColumn& column);

/// Filter on features. For one thread.
struct FeatureFilter {
    FeatureTest test;
    std::optional<GeoBox> box{}; ///< no feature outside of it passes
};

/// Makes a filter from an expression. Properties are the values that a client sees, rounded; a
/// feature whose value is unknown passes neither a comparison nor its contrary (three-valued logic,
/// as in SQL).
///
/// \param columns  outlive the filter
/// \param crs      of the coordinates in the expression
/// \throws Cql2Error  for unknown properties, and for operands of types that do not go together.
FeatureFilter feature_filter(const Cql2Expression& expression,
                             std::span<const FeatureColumn> columns,
                             CoordinateReference crs);

} // namespace macadam
