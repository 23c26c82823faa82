#include "mapping/style/road_widths.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace macadam {
namespace {

// Size of a pixel at zoom 0 of web maps with tiles of 256 px: the equator of WGS 84 / 256.
constexpr double metres_per_px_at_zoom_0 = 2 * std::numbers::pi * 6378137.0 / 256;

using Rule = RoadWidths;

} // namespace

double road_width_px(double zoom) {
    const double grown = std::pow(Rule::growth_per_zoom, zoom - Rule::first_zoom);
    return std::clamp(Rule::constant_px + Rule::growing_px * grown, Rule::min_px, Rule::max_px);
}

double road_casing_px(double width_px) {
    return std::clamp(
        Rule::casing_px + Rule::casing_share * width_px, Rule::min_casing_px, Rule::max_casing_px);
}

double denominator_of_zoom(double zoom, double px_mm) {
    return metres_per_px_at_zoom_0 * 1000 / px_mm / std::exp2(zoom);
}

double zoom_of_metres_per_px(double metres_per_px) {
    return std::log2(metres_per_px_at_zoom_0 / metres_per_px);
}

} // namespace macadam
