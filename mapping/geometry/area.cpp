#include "mapping/geometry/area.hpp"

#include "mapping/geometry/antimeridian.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr std::size_t sides_per_band = 4;
constexpr std::size_t max_bands = 4096;
constexpr double max_entries_per_side = 8; // in all bands together, in the mean

/// Twice the signed area of a triangle, above 0 if it turns left.
double turn(const GeoPoint& a, const GeoPoint& b, const GeoPoint& c) {
    return (b.lon_deg - a.lon_deg) * (c.lat_deg - a.lat_deg) -
           (b.lat_deg - a.lat_deg) * (c.lon_deg - a.lon_deg);
}

/// Tests whether two segments cross at a point inside both. Touching ends are found by the test of
/// points.
bool cross(const GeoPoint& a, const GeoPoint& b, const GeoPoint& c, const GeoPoint& d) {
    return (turn(a, b, c) > 0) != (turn(a, b, d) > 0) && (turn(c, d, a) > 0) != (turn(c, d, b) > 0);
}

/// Number of bands, in which long sides stand often: some 8 entries a side at most.
template <typename Sides>
std::size_t band_count(const Sides& sides, double height_deg) {
    double spans_deg = 0;
    for (const auto& side : sides) {
        spans_deg += std::abs(side.a.lat_deg - side.b.lat_deg);
    }
    const auto usual = std::clamp<std::size_t>(sides.size() / sides_per_band, 1, max_bands);
    const double crossed = height_deg > 0 ? spans_deg / height_deg : 0; // sides in a band
    const double most = crossed > 0
                            ? max_entries_per_side * static_cast<double>(sides.size()) / crossed
                            : static_cast<double>(usual);
    return std::max<std::size_t>(1, std::min(usual, static_cast<std::size_t>(std::min(most, 1e6))));
}

} // namespace

Area::Area(const std::vector<Polygon>& polygons) {
    std::vector<Side> sides;
    for (std::size_t i = 0; i < polygons.size(); ++i) {
        for (const auto& ring : polygons[i]) {
            for (std::size_t j = 0; ring.size() >= 3 && j < ring.size(); ++j) {
                box_ = including(box_, ring[j]);
                sides.push_back({ring[j], ring[(j + 1) % ring.size()], i});
            }
        }
    }
    bands_.resize(band_count(sides, box_.north_deg - box_.south_deg));
    for (const auto& side : sides) {
        const auto [low, high] = std::minmax(side.a.lat_deg, side.b.lat_deg);
        for (auto band = band_of(low); band <= band_of(high); ++band) {
            bands_[band].push_back(side);
        }
    }
}

std::size_t Area::band_of(double lat_deg) const {
    const double height_deg = box_.north_deg - box_.south_deg;
    const double share = height_deg > 0 ? (lat_deg - box_.south_deg) / height_deg : 0;
    const auto count = static_cast<double>(bands_.size());
    return static_cast<std::size_t>(std::clamp(std::floor(share * count), 0.0, count - 1));
}

bool Area::contains(const GeoPoint& point) const {
    if (!macadam::contains(box_, point)) {
        return false;
    }
    // Sides of a polygon follow each other in a band.
    bool inside = false;
    std::size_t polygon = 0;
    for (const auto& side : bands_[band_of(point.lat_deg)]) {
        if (side.polygon != polygon) {
            if (inside) {
                return true;
            }
            polygon = side.polygon;
        }
        const auto& [a, b] = std::pair{side.a, side.b};
        if ((a.lat_deg > point.lat_deg) != (b.lat_deg > point.lat_deg)) {
            const double share = (point.lat_deg - a.lat_deg) / (b.lat_deg - a.lat_deg);
            inside = inside != (point.lon_deg < a.lon_deg + share * (b.lon_deg - a.lon_deg));
        }
    }
    return inside;
}

bool Area::intersects(std::span<const GeoPoint> line) const {
    if (!crosses_antimeridian(line)) {
        return intersects_unbroken(line);
    }
    const auto parts = cut_at_antimeridian(line);
    return std::ranges::any_of(parts, [&](const auto& part) { return intersects_unbroken(part); });
}

bool Area::intersects_unbroken(std::span<const GeoPoint> line) const {
    if (std::ranges::any_of(line, [&](const GeoPoint& point) { return contains(point); })) {
        return true;
    }
    for (std::size_t i = 1; i < line.size(); ++i) {
        const auto& [a, b] = std::pair{line[i - 1], line[i]};
        const auto [low, high] = std::minmax(a.lat_deg, b.lat_deg);
        for (auto band = band_of(low); band <= band_of(high); ++band) {
            if (std::ranges::any_of(
                    bands_[band], [&](const Side& side) { return cross(a, b, side.a, side.b); })) {
                return true;
            }
        }
    }
    return false;
}

} // namespace macadam
