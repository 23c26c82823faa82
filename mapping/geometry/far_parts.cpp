#include "mapping/geometry/far_parts.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace macadam {
namespace {

constexpr int reach = 5; // cells from one to the next of the same part

void grow_by(FarParts::Part& part, const FarParts::Part& other) {
    part.weight += other.weight;
    part.box = including(part.box, {other.box.south_deg, other.box.west_deg});
    part.box = including(part.box, {other.box.north_deg, other.box.east_deg});
}

} // namespace

void FarParts::add(const GeoPoint& at, double weight) {
    const double cos_lat = std::cos((box_.south_deg + box_.north_deg) / 2 * std::numbers::pi / 180);
    const double longer_deg = std::max(
        {(box_.east_deg - box_.west_deg) * cos_lat, box_.north_deg - box_.south_deg, 1e-9});
    const auto cell = [&](double deg) {
        return std::clamp(int(deg / longer_deg * side), 0, side - 1);
    };
    const int column = cell((at.lon_deg - box_.west_deg) * cos_lat);
    const int row = cell(at.lat_deg - box_.south_deg);
    auto& part = cells_[std::size_t(row) * side + std::size_t(column)];
    part.box = including(part.box, at);
    part.weight += weight;
}

std::vector<FarParts::Part> FarParts::parts() const {
    std::vector<bool> taken(cells_.size(), false);
    std::vector<Part> parts;
    for (std::size_t first = 0; first < cells_.size(); ++first) {
        if (taken[first] || is_empty(cells_[first].box)) {
            continue;
        }
        Part part;
        std::vector<std::size_t> open{first};
        taken[first] = true;
        while (!open.empty()) {
            const auto at = open.back();
            open.pop_back();
            grow_by(part, cells_[at]);
            const int row = int(at) / side;
            const int column = int(at) % side;
            for (int y = std::max(0, row - reach); y <= std::min(side - 1, row + reach); ++y) {
                for (int x = std::max(0, column - reach); x <= std::min(side - 1, column + reach);
                     ++x) {
                    const auto next = std::size_t(y) * side + std::size_t(x);
                    if (!taken[next] && !is_empty(cells_[next].box)) {
                        taken[next] = true;
                        open.push_back(next);
                    }
                }
            }
        }
        parts.push_back(part);
    }
    std::ranges::stable_sort(parts, std::ranges::greater{}, &Part::weight);
    return parts;
}

} // namespace macadam
