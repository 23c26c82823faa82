#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace macadam {

/// Corner of a ring on a plane.
struct RingPoint {
    double x, y;
    friend bool operator==(const RingPoint&, const RingPoint&) = default;
};

/// Finds the ring around each point by a sweep over all of them: the number of the first ring that
/// holds it, or that of the rings if none does. The first point of a ring is not repeated.
///
/// \returns `std::nullopt` if it would take more comparisons of points and sides than that, as with
///          very many rings of long sides.
std::optional<std::vector<std::size_t>> rings_around(std::span<const std::vector<RingPoint>> rings,
                                                     std::span<const RingPoint> points,
                                                     std::size_t max_comparisons = 2'000'000'000);

} // namespace macadam
