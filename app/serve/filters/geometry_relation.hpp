#pragma once

#include "app/serve/features/coordinate_reference.hpp"
#include "app/serve/features/feature.hpp"
#include "app/serve/filters/cql2_expression.hpp"
#include "estimator/common/geo.hpp"

#include <memory>
#include <optional>
#include <string_view>

namespace macadam {

/// Spatial function of two geometries, each that of a feature or a literal, in the plane of degrees
/// (GEOS). For one thread.
class GeometryRelation {
public:
    /// \param function  "s_intersects" and the like
    /// \param a, b      null: the feature's
    /// \throws Cql2Error  for coordinates that are not on the globe, and for geometries that are
    ///                    not valid, such as a polygon that crosses itself.
    GeometryRelation(std::string_view function,
                     const Cql2Geometry* a,
                     const Cql2Geometry* b,
                     CoordinateReference crs);
    ~GeometryRelation();
    GeometryRelation(const GeometryRelation&) = delete;
    GeometryRelation& operator=(const GeometryRelation&) = delete;

    bool holds(const Feature& feature) const;

    /// Box outside of which it holds for no feature; `std::nullopt` if there is none.
    std::optional<GeoBox> box() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace macadam
