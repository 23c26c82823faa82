#pragma once

#include "estimator/common/geo.hpp"

#include <cstddef>
#include <cstdint>
#include <set>
#include <unordered_map>

namespace macadam {

/// Surroundings of positions, such as those of trips, as cells of a grid. Memory grows with the
/// area, not with the number of positions.
class Surroundings {
public:
    /// \param reach_m  distance within which a place belongs to the surroundings, above 0; of
    ///                 places up to 2.5 times as far, some do.
    explicit Surroundings(double reach_m);

    static constexpr std::size_t max_cells = 1'000'000;

    /// Adds the surroundings of a position; none for a position that is not on the globe.
    /// \throws InputError  if positions are in more than `max_cells` cells of a third of the reach.
    void add(const GeoPoint& position);

    bool contains(const GeoPoint& place) const;

    bool empty() const { return cells_ == 0; }
    double reach_m() const { return reach_m_; }
    const GeoBox& box() const { return box_; } ///< of the positions

private:
    double lon_step_deg(std::int64_t row) const;
    std::int64_t row_of(const GeoPoint& place) const;
    std::int64_t column_of(const GeoPoint& place, std::int64_t row) const;

    double reach_m_;
    double row_deg_; ///< height of a cell
    GeoBox box_;
    std::size_t cells_ = 0;                                             ///< that hold positions
    std::unordered_map<std::int64_t, std::set<std::int64_t>> occupied_; ///< columns of rows
};

} // namespace macadam
