#include "mapping/geometry/antimeridian.hpp"

#include <cmath>

namespace macadam {
namespace {

constexpr double half_turn_deg = 180;
constexpr double turn_deg = 360;

double short_way_deg(double from_deg, double to_deg) {
    return std::remainder(to_deg - from_deg, turn_deg);
}

bool steps_over(const GeoPoint& a, const GeoPoint& b) {
    return std::abs(b.lon_deg - a.lon_deg) > half_turn_deg;
}

} // namespace

bool crosses_antimeridian(std::span<const GeoPoint> line) {
    for (std::size_t i = 1; i < line.size(); ++i) {
        if (steps_over(line[i - 1], line[i])) {
            return true;
        }
    }
    return false;
}

std::vector<std::vector<GeoPoint>> cut_at_antimeridian(std::span<const GeoPoint> line) {
    std::vector<std::vector<GeoPoint>> parts(1);
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (i > 0 && steps_over(line[i - 1], line[i])) {
            const auto& a = line[i - 1];
            const auto& b = line[i];
            const double side_deg = std::copysign(half_turn_deg, a.lon_deg);
            const double way_deg = short_way_deg(a.lon_deg, b.lon_deg);
            const double share = way_deg == 0 ? 0.0 : (side_deg - a.lon_deg) / way_deg;
            const double lat_deg = std::lerp(a.lat_deg, b.lat_deg, share);
            // A line that begins or ends on the meridian needs no empty part.
            const GeoPoint before{lat_deg, side_deg};
            const GeoPoint after{lat_deg, -side_deg};
            if (parts.back().back() != before) {
                parts.back().push_back(before);
            }
            if (parts.back().size() < 2) {
                parts.pop_back();
            }
            parts.emplace_back();
            if (after != b) {
                parts.back().push_back(after);
            }
        }
        parts.back().push_back(line[i]);
    }
    if (parts.size() > 1 && parts.back().size() < 2) {
        parts.pop_back();
    }
    return parts;
}

std::vector<GeoPoint> unwrapped(std::span<const GeoPoint> line, double near_lon_deg) {
    std::vector<GeoPoint> smooth;
    smooth.reserve(line.size());
    double last_deg = near_lon_deg;
    for (const auto& point : line) {
        const bool near = std::abs(point.lon_deg - last_deg) <= half_turn_deg;
        last_deg = near ? point.lon_deg : last_deg + short_way_deg(last_deg, point.lon_deg);
        smooth.push_back({point.lat_deg, last_deg});
    }
    return smooth;
}

GeoBox grown_over(const GeoBox& box, double margin_m) {
    if (box.east_deg <= half_turn_deg) {
        return grown(box, margin_m);
    }
    const double turned_deg = (box.west_deg + box.east_deg) / 2; // centred, to avoid clipping
    const auto large =
        grown({box.west_deg - turned_deg, box.south_deg, box.east_deg - turned_deg, box.north_deg},
              margin_m);
    return {
        large.west_deg + turned_deg, large.south_deg, large.east_deg + turned_deg, large.north_deg};
}

std::vector<GeoBox> parts_on_globe(const GeoBox& box) {
    if (box.east_deg <= half_turn_deg) {
        return {box};
    }
    if (box.west_deg >= half_turn_deg) {
        return {{box.west_deg - turn_deg, box.south_deg, box.east_deg - turn_deg, box.north_deg}};
    }
    return {{box.west_deg, box.south_deg, half_turn_deg, box.north_deg},
            {-half_turn_deg, box.south_deg, box.east_deg - turn_deg, box.north_deg}};
}

} // namespace macadam
