#pragma once

#include "render/projection/projection.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <unordered_map>
#include <vector>

namespace macadam {

bool overlap(const PixelBox& a, const PixelBox& b);

/// Returns the union of two boxes.
PixelBox both(const PixelBox& a, const PixelBox& b);

/// Returns the bounding box of at least one point, grown by a margin.
PixelBox box_around(std::span<const PixelPoint> points, double margin_px);

/// Spatial index of numbered boxes: a hash grid.
class BoxGrid {
public:
    explicit BoxGrid(double square_px) : square_px_{square_px} {}

    void add(const PixelBox& box, std::size_t number);

    /// \param box  as it was added
    void remove(const PixelBox& box, std::size_t number);

    /// Returns true if `is_hit` is true for the number of a box near `box`. A number may be asked
    /// for several times.
    bool any_near(const PixelBox& box, const std::function<bool(std::size_t)>& is_hit) const;

private:
    template <typename Visit>
    void visit_squares(const PixelBox& box, const Visit& visit) const;

    double square_px_;
    std::unordered_map<std::uint64_t, std::vector<std::size_t>> squares_;
};

} // namespace macadam
