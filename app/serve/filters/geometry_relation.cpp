#include "app/serve/filters/geometry_relation.hpp"

#include "mapping/geometry/antimeridian.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>
#include <geos_c.h>

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace macadam {
namespace {

using Kind = Cql2Geometry::Kind;
using Context = std::unique_ptr<GEOSContextHandle_HS, decltype(&GEOS_finish_r)>;
using Deleter = std::function<void(GEOSGeometry*)>;
using Geometry = std::unique_ptr<GEOSGeometry, Deleter>;

/// Predicates by their function: of two geometries, and of a prepared one, whose operands are
/// swapped.
struct Predicate {
    std::string_view function;
    char (*plain)(GEOSContextHandle_t, const GEOSGeometry*, const GEOSGeometry*);
    char (*prepared)(GEOSContextHandle_t, const GEOSPreparedGeometry*, const GEOSGeometry*);
    char (*swapped)(GEOSContextHandle_t, const GEOSPreparedGeometry*, const GEOSGeometry*);
};

constexpr std::array predicates{
    Predicate{"s_intersects", GEOSIntersects_r, GEOSPreparedIntersects_r, GEOSPreparedIntersects_r},
    Predicate{"s_disjoint", GEOSDisjoint_r, GEOSPreparedDisjoint_r, GEOSPreparedDisjoint_r},
    Predicate{"s_within", GEOSWithin_r, GEOSPreparedWithin_r, GEOSPreparedContains_r},
    Predicate{"s_contains", GEOSContains_r, GEOSPreparedContains_r, GEOSPreparedWithin_r},
    Predicate{"s_touches", GEOSTouches_r, GEOSPreparedTouches_r, GEOSPreparedTouches_r},
    Predicate{"s_overlaps", GEOSOverlaps_r, GEOSPreparedOverlaps_r, GEOSPreparedOverlaps_r},
    Predicate{"s_crosses", GEOSCrosses_r, GEOSPreparedCrosses_r, GEOSPreparedCrosses_r},
    Predicate{"s_equals", GEOSEquals_r, nullptr, nullptr},
};

/// Makes geometries of GEOS, longitude first.
class Maker {
public:
    Maker(GEOSContextHandle_t context, CoordinateReference crs) : context_{context}, crs_{crs} {}

    Geometry owned(GEOSGeometry* geometry) const {
        if (geometry == nullptr) {
            throw Cql2Error{"a geometry cannot be used"};
        }
        return {geometry,
                [context = context_](GEOSGeometry* each) { GEOSGeom_destroy_r(context, each); }};
    }

    Geometry line(std::span<const GeoPoint> points) const {
        return points.size() == 1 ? owned(GEOSGeom_createPoint_r(context_, sequence(points)))
                                  : owned(GEOSGeom_createLineString_r(context_, sequence(points)));
    }

    Geometry collection(int type, std::vector<Geometry> parts) const {
        std::vector<GEOSGeometry*> taken;
        for (auto& part : parts) {
            taken.push_back(part.release());
        }
        return owned(GEOSGeom_createCollection_r(
            context_, type, taken.data(), static_cast<unsigned>(taken.size())));
    }

    Geometry of(const Cql2Geometry& geometry) const {
        switch (geometry.kind) {
        case Kind::point:
        case Kind::line:
            return line(points_of(geometry.lines.front()));
        case Kind::polygon:
            return polygon(geometry.lines);
        case Kind::multi_point:
            return collection(GEOS_MULTIPOINT, lines(geometry.lines));
        case Kind::multi_line:
            return collection(GEOS_MULTILINESTRING, lines(geometry.lines));
        case Kind::multi_polygon:
            return collection(GEOS_MULTIPOLYGON, parts(geometry.parts));
        case Kind::collection:
            return collection(GEOS_GEOMETRYCOLLECTION, parts(geometry.parts));
        case Kind::box:
            break;
        }
        return box(geometry.lines.front());
    }

private:
    GEOSCoordSequence* sequence(std::span<const GeoPoint> points) const {
        std::vector<double> numbers;
        numbers.reserve(2 * points.size());
        for (const auto& [lat_deg, lon_deg] : points) {
            numbers.push_back(lon_deg);
            numbers.push_back(lat_deg);
        }
        return GEOSCoordSeq_copyFromBuffer_r(
            context_, numbers.data(), static_cast<unsigned>(points.size()), 0, 0);
    }

    GeoPoint point_of(const std::pair<double, double>& position) const {
        const auto point = geo_point_of(crs_, position.first, position.second);
        if (!(point.lat_deg >= -90 && point.lat_deg <= 90 && point.lon_deg >= -180 &&
              point.lon_deg <= 180)) {
            throw Cql2Error{
                fmt::format("position {} {} is not on the globe", position.first, position.second)};
        }
        return point;
    }

    std::vector<GeoPoint> points_of(const Cql2Line& line) const {
        std::vector<GeoPoint> points;
        std::ranges::transform(line, std::back_inserter(points), [this](const auto& position) {
            return point_of(position);
        });
        return points;
    }

    std::vector<Geometry> lines(const std::vector<Cql2Line>& all) const {
        std::vector<Geometry> made;
        for (const auto& each : all) {
            made.push_back(line(points_of(each)));
        }
        return made;
    }

    std::vector<Geometry> parts(const std::vector<Cql2Geometry>& all) const {
        std::vector<Geometry> made;
        for (const auto& each : all) {
            made.push_back(of(each));
        }
        return made;
    }

    Geometry polygon(const std::vector<Cql2Line>& rings) const {
        std::vector<Geometry> made;
        for (const auto& ring : rings) {
            made.push_back(owned(GEOSGeom_createLinearRing_r(context_, sequence(points_of(ring)))));
        }
        std::vector<GEOSGeometry*> holes;
        for (auto hole = made.begin() + 1; hole != made.end(); ++hole) {
            holes.push_back(hole->release());
        }
        return owned(GEOSGeom_createPolygon_r(
            context_, made.front().release(), holes.data(), static_cast<unsigned>(holes.size())));
    }

    /// One box, or two beside the antimeridian; a line or a point if it has no width.
    Geometry box(const Cql2Line& corners) const {
        const auto low = point_of(corners[0]), top = point_of(corners[1]);
        if (low.lat_deg > top.lat_deg) {
            throw Cql2Error{"a box has its south north of its north"};
        }
        const bool crosses = low.lon_deg > top.lon_deg;
        std::vector<Geometry> boxes;
        for (const auto& [west, south, east, north] :
             parts_on_globe({low.lon_deg,
                             low.lat_deg,
                             crosses ? top.lon_deg + 360 : top.lon_deg,
                             top.lat_deg})) {
            boxes.push_back(rectangle(west, south, east, north));
        }
        return boxes.size() == 1 ? std::move(boxes.front())
                                 : collection(GEOS_MULTIPOLYGON, std::move(boxes));
    }

    Geometry rectangle(double west, double south, double east, double north) const {
        const std::array<GeoPoint, 2> ends{GeoPoint{south, west}, GeoPoint{north, east}};
        if (west == east || south == north) {
            return line(std::span{ends}.first(west == east && south == north ? 1 : 2));
        }
        return owned(GEOSGeom_createRectangle_r(context_, west, south, east, north));
    }

    GEOSContextHandle_t context_;
    CoordinateReference crs_;
};

} // namespace

struct GeometryRelation::Impl {
    using Prepared = std::unique_ptr<const GEOSPreparedGeometry,
                                     std::function<void(const GEOSPreparedGeometry*)>>;

    explicit Impl(CoordinateReference crs) : maker{context.get(), crs} {}

    /// Geometry of a literal; null for the feature's.
    Geometry literal(const Cql2Geometry* geometry) const {
        if (geometry == nullptr) {
            return nullptr;
        }
        auto made = maker.of(*geometry);
        if (GEOSisValid_r(context.get(), made.get()) != 1) {
            throw Cql2Error{"a geometry is not valid: its lines cross where they may not"};
        }
        return made;
    }

    /// Geometry of a feature as clients see it, so that they find it by its own positions.
    Geometry of(const Feature& feature) const {
        std::vector<GeoPoint> line;
        std::ranges::transform(feature.line, std::back_inserter(line), as_shown);
        if (feature.is_point || !crosses_antimeridian(line)) {
            return maker.line(line);
        }
        std::vector<Geometry> parts;
        for (const auto& part : cut_at_antimeridian(line)) {
            parts.push_back(maker.line(part));
        }
        return maker.collection(GEOS_MULTILINESTRING, std::move(parts));
    }

    Context context{GEOS_init_r(), GEOS_finish_r};
    Maker maker;
    const Predicate* predicate = nullptr;
    Geometry a, b;
    Prepared prepared{nullptr, {}};
};

GeometryRelation::GeometryRelation(std::string_view function,
                                   const Cql2Geometry* a,
                                   const Cql2Geometry* b,
                                   CoordinateReference crs)
    : impl_{std::make_unique<Impl>(crs)} {
    impl_->predicate = std::ranges::find(predicates, function, &Predicate::function);
    if (impl_->predicate == predicates.end()) {
        throw Cql2Error{fmt::format("there is no function {}", in_quotes(function))};
    }
    impl_->a = impl_->literal(a);
    impl_->b = impl_->literal(b);
    const bool is_of_any = function == "s_intersects" || function == "s_disjoint";
    for (const auto* each : {a, b}) {
        if (!is_of_any && each != nullptr && each->kind == Kind::collection) {
            throw Cql2Error{fmt::format("{} takes no collection of geometries", function)};
        }
    }
    auto* const context = impl_->context.get();
    if ((impl_->a == nullptr) != (impl_->b == nullptr) && impl_->predicate->prepared != nullptr) {
        const auto* const literal = impl_->a ? impl_->a.get() : impl_->b.get();
        impl_->prepared = {GEOSPrepare_r(context, literal),
                           [context](const GEOSPreparedGeometry* each) {
                               GEOSPreparedGeom_destroy_r(context, each);
                           }};
    }
}

GeometryRelation::~GeometryRelation() = default;

bool GeometryRelation::holds(const Feature& feature) const {
    const auto& [context, maker, predicate, a, b, prepared] = *impl_;
    const auto own = impl_->of(feature);
    if (prepared) {
        return (a ? predicate->prepared
                  : predicate->swapped)(context.get(), prepared.get(), own.get()) == 1;
    }
    return predicate->plain(context.get(), a ? a.get() : own.get(), b ? b.get() : own.get()) == 1;
}

std::optional<GeoBox> GeometryRelation::box() const {
    if (impl_->predicate->function == "s_disjoint" ||
        (impl_->a == nullptr) == (impl_->b == nullptr)) {
        return std::nullopt;
    }
    const auto* const literal = impl_->a ? impl_->a.get() : impl_->b.get();
    auto* const context = impl_->context.get();
    GeoBox box;
    const bool has_box = GEOSGeom_getXMin_r(context, literal, &box.west_deg) == 1 &&
                         GEOSGeom_getYMin_r(context, literal, &box.south_deg) == 1 &&
                         GEOSGeom_getXMax_r(context, literal, &box.east_deg) == 1 &&
                         GEOSGeom_getYMax_r(context, literal, &box.north_deg) == 1;
    return has_box ? std::optional{box} : std::nullopt;
}

} // namespace macadam
