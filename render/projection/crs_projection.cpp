#include "render/projection/crs_projection.hpp"

#include "estimator/common/plugin_library.hpp"

namespace macadam {

std::shared_ptr<const PlaneProjection> plane_projection(const std::string& crs) {
    auto projection = std::make_shared<PlaneProjection>();
    projection->crs = crs;
    plugin_function<ProjOpen>("macadam_proj.so", proj_open_name)(crs, *projection);
    return projection;
}

} // namespace macadam
