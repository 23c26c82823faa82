#pragma once

#include "estimator/common/geo.hpp"

#include <cstdint>
#include <unordered_set>

namespace macadam {

/// Surroundings of positions, such as those of trips, as cells of a grid. Memory grows with the
/// area, not with the number of positions.
class Surroundings {
public:
    /// \param reach_m  distance within which a place belongs to the surroundings, above 0; of
    ///                 places up to 2.5 times as far, some do.
    explicit Surroundings(double reach_m);

    /// Adds the surroundings of a position; none for a position that is not on the globe.
    void add(const GeoPoint& position);

    bool contains(const GeoPoint& place) const;

    bool empty() const { return cells_.empty(); }
    double reach_m() const { return reach_m_; }
    const GeoBox& box() const { return box_; } ///< of the positions

private:
    double lon_step_deg(std::int64_t row) const;
    static std::uint64_t cell_of(std::int64_t row, std::int64_t column);

    double reach_m_;
    double row_deg_; ///< height of a cell
    GeoBox box_;
    std::unordered_set<std::uint64_t> occupied_; ///< cells of the positions
    std::unordered_set<std::uint64_t> cells_;
};

} // namespace macadam
