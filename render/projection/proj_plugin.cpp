#include "render/projection/crs_projection.hpp"

#include "estimator/common/error.hpp"

#include <fmt/core.h>
#include <proj.h>

#include <cmath>

namespace macadam {
namespace {

struct Release {
    void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
    void operator()(PJ* pj) const { proj_destroy(pj); }
};

using Context = std::shared_ptr<PJ_CONTEXT>;
using Owned = std::unique_ptr<PJ, Release>;

[[noreturn]] void refuse(const std::string& crs, const std::string& cause) {
    throw InputError{
        fmt::format("the projection '{}': {}, expected a projected or geographic coordinate "
                    "reference system that PROJ knows, such as EPSG:3006",
                    crs,
                    cause)};
}

/// Converts a definition to that of a coordinate system: "+proj=utm +zone=33" is an operation, and
/// a map needs the system of its results.
std::string as_system(const std::string& crs) {
    const bool is_operation =
        crs.find("+proj=") != std::string::npos || crs.find("+init=") != std::string::npos;
    return is_operation && crs.find("+type=crs") == std::string::npos ? crs + " +type=crs" : crs;
}

/// Rejects "compound" and "geocentric" systems, which have heights.
void expect_flat(PJ_CONTEXT* context, const PJ* system, const std::string& crs) {
    switch (proj_get_type(system)) {
    case PJ_TYPE_PROJECTED_CRS:
    case PJ_TYPE_GEOGRAPHIC_2D_CRS:
        return;
    case PJ_TYPE_BOUND_CRS: {
        const Owned source{proj_get_source_crs(context, system)};
        if (source) {
            expect_flat(context, source.get(), crs);
            return;
        }
        break;
    }
    default:
        break;
    }
    refuse(crs, "is not a coordinate reference system");
}

std::string wkt_of(PJ_CONTEXT* context, const PJ* system) {
    for (const auto form : {PJ_WKT1_GDAL, PJ_WKT2_2019}) {
        const char* const options[]{"MULTILINE=NO", nullptr};
        if (const char* const text = proj_as_wkt(context, system, form, options)) {
            return text;
        }
    }
    return {};
}

PJ_COORD through(PJ* pj, PJ_DIRECTION direction, double a, double b) {
    proj_errno_reset(pj);
    return proj_trans(pj, direction, proj_coord(a, b, 0, 0));
}

void open(const std::string& crs, PlaneProjection& projection) {
    const Context context{proj_context_create(), Release{}};
    proj_log_level(context.get(), PJ_LOG_NONE);
    proj_context_set_enable_network(context.get(), 0); // the same on every machine
    const Owned system{proj_create(context.get(), as_system(crs).c_str())};
    if (!system) {
        refuse(crs, "is unknown to PROJ");
    }
    expect_flat(context.get(), system.get(), crs);
    const Owned wgs84{proj_create(context.get(), "EPSG:4326")};
    const Owned raw{wgs84 ? proj_create_crs_to_crs_from_pj(
                                context.get(), wgs84.get(), system.get(), nullptr, nullptr)
                          : nullptr};
    Owned easy{raw ? proj_normalize_for_visualization(context.get(), raw.get()) : nullptr};
    if (!easy) {
        refuse(crs, "PROJ has no transformation to it from WGS 84; its database may be missing");
    }
    projection.wkt = wkt_of(context.get(), system.get());
    const std::shared_ptr<PJ> pj{easy.release(), [context](PJ* p) { proj_destroy(p); }};
    projection.to_plane = [pj](const GeoPoint& point) -> std::optional<PlanePoint> {
        const auto xy = through(pj.get(), PJ_FWD, point.lon_deg, point.lat_deg).xy;
        return std::isfinite(xy.x) && std::isfinite(xy.y) ? std::optional{PlanePoint{xy.x, xy.y}}
                                                          : std::nullopt;
    };
    projection.to_geo = [pj](const PlanePoint& point) -> std::optional<GeoPoint> {
        const auto lonlat = through(pj.get(), PJ_INV, point.x, point.y).xy;
        return std::isfinite(lonlat.x) && std::isfinite(lonlat.y)
                   ? std::optional{GeoPoint{lonlat.y, lonlat.x}}
                   : std::nullopt;
    };
}

} // namespace
} // namespace macadam

extern "C" void macadam_proj_open(const std::string& crs, macadam::PlaneProjection& projection) {
    macadam::open(crs, projection);
}
