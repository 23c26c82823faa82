#include "mapping/geometry/surroundings.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace macadam {
namespace {

// Shortest degree of latitude, at the equator; a degree of longitude on the ellipsoid is never
// shorter than this times the cosine of the latitude.
constexpr double m_per_deg = 110'574;

constexpr std::int64_t cells_per_reach = 3;

} // namespace

Surroundings::Surroundings(double reach_m)
    : reach_m_{reach_m}, row_deg_{reach_m / m_per_deg / cells_per_reach} {}

/// Width of the cells of a row: their height, at the row's end nearer to the pole.
double Surroundings::lon_step_deg(std::int64_t row) const {
    const double end_deg =
        std::max(std::abs(static_cast<double>(row)), std::abs(static_cast<double>(row + 1))) *
        row_deg_;
    constexpr double least_cosine = 0.001; // beyond 89.9 degrees
    const double cosine = std::cos(std::min(90.0, end_deg) * std::numbers::pi / 180);
    return row_deg_ / std::max(least_cosine, cosine);
}

std::int64_t Surroundings::row_of(const GeoPoint& place) const {
    return static_cast<std::int64_t>(std::floor(place.lat_deg / row_deg_));
}

std::int64_t Surroundings::column_of(const GeoPoint& place, std::int64_t row) const {
    return static_cast<std::int64_t>(std::floor(place.lon_deg / lon_step_deg(row)));
}

void Surroundings::add(const GeoPoint& position) {
    const bool on_globe = std::abs(position.lat_deg) <= 90 && std::abs(position.lon_deg) <= 180;
    if (!on_globe) {
        return;
    }
    box_ = including(box_, position);
    const auto row = row_of(position);
    if (occupied_[row].insert(column_of(position, row)).second && ++cells_ > max_cells) {
        throw InputError{
            fmt::format("trips are at more than {} places {:.0f} m apart, too many to take the "
                        "roads around them: expected fewer trips, or a smaller map taken whole",
                        max_cells,
                        reach_m_ / cells_per_reach)};
    }
}

bool Surroundings::contains(const GeoPoint& place) const {
    // One column more, as columns of rows nearer to the equator are narrower.
    constexpr auto columns = cells_per_reach + 1;
    const auto row = row_of(place);
    for (auto near_row = row - cells_per_reach; near_row <= row + cells_per_reach; ++near_row) {
        const auto found = occupied_.find(near_row);
        if (found == occupied_.end()) {
            continue;
        }
        const auto column = column_of(place, near_row);
        const auto first = found->second.lower_bound(column - columns);
        if (first != found->second.end() && *first <= column + columns) {
            return true;
        }
    }
    return false;
}

} // namespace macadam
