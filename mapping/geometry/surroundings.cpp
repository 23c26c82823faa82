#include "mapping/geometry/surroundings.hpp"

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

std::uint64_t Surroundings::cell_of(std::int64_t row, std::int64_t column) {
    constexpr unsigned half_bits = 32;
    return static_cast<std::uint64_t>(row) << half_bits |
           (static_cast<std::uint64_t>(column) & 0xffffffffU);
}

void Surroundings::add(const GeoPoint& position) {
    const bool on_globe = std::abs(position.lat_deg) <= 90 && std::abs(position.lon_deg) <= 180;
    if (!on_globe) {
        return;
    }
    box_ = including(box_, position);
    const auto row = static_cast<std::int64_t>(std::floor(position.lat_deg / row_deg_));
    const auto column_in = [&](std::int64_t of_row) {
        return static_cast<std::int64_t>(std::floor(position.lon_deg / lon_step_deg(of_row)));
    };
    if (!occupied_.insert(cell_of(row, column_in(row))).second) {
        return;
    }
    // One column more, as another position in this cell may lie in another column of other rows.
    constexpr auto columns = cells_per_reach + 1;
    for (auto near_row = row - cells_per_reach; near_row <= row + cells_per_reach; ++near_row) {
        const auto column = column_in(near_row);
        for (auto near_column = column - columns; near_column <= column + columns; ++near_column) {
            cells_.insert(cell_of(near_row, near_column));
        }
    }
}

bool Surroundings::contains(const GeoPoint& place) const {
    const auto row = static_cast<std::int64_t>(std::floor(place.lat_deg / row_deg_));
    const auto column = static_cast<std::int64_t>(std::floor(place.lon_deg / lon_step_deg(row)));
    return cells_.contains(cell_of(row, column));
}

} // namespace macadam
