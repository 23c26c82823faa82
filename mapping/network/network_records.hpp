#pragma once

#include "estimator/common/geo.hpp"

#include <cstdint>
#include <ranges>
#include <span>

namespace macadam {

// How a RoadNetwork lies in memory and in its file: plain records without gaps, read in place.

/// A place on the grid of 1e-7 degrees, OSM's own: 1.1 cm of latitude.
struct PackedPoint {
    std::int32_t lat_e7;
    std::int32_t lon_e7;
    friend bool operator==(const PackedPoint&, const PackedPoint&) = default;
};

/// The nearest place of the grid.
PackedPoint packed(const GeoPoint& place);

struct Unpacked {
    static constexpr double per_deg = 1e7;
    static constexpr double per_m = 1000;

    GeoPoint operator()(const PackedPoint& point) const {
        return {point.lat_e7 / per_deg, point.lon_e7 / per_deg};
    }
    double operator()(std::uint32_t length_mm) const { return length_mm / per_m; }
};

/// Places and lengths as they are asked for: ranges with [], size, front, back.
using PlaceRange = std::ranges::transform_view<std::span<const PackedPoint>, Unpacked>;
using LengthRange = std::ranges::transform_view<std::span<const std::uint32_t>, Unpacked>;

/// Where a way's points, links and turn rules begin; they end where the next way's begin.
struct PackedWay {
    std::int64_t id;
    std::uint32_t first_point;
    std::uint32_t first_link;
    std::uint32_t first_turn;
    std::uint32_t name; ///< number of a text
    std::uint32_t highway;
    std::uint16_t speed_limit_cmps; ///< as signposted; 0: not known
    std::uint8_t oneway;
    std::uint8_t zero;
};
static_assert(sizeof(PackedWay) == 32);

/// Its last point is the next link's first, or the way's last.
struct PackedLink {
    std::uint32_t way;
    std::uint32_t from; ///< nodes
    std::uint32_t to;
    std::uint32_t first_point; ///< of all points
    std::uint32_t first_segment;
    std::uint32_t length_mm;
    std::uint16_t speed_limit_cmps; ///< signposted or usual
    std::uint16_t flags;
};
static_assert(sizeof(PackedLink) == 28);

namespace link_flags {
inline constexpr std::uint16_t forward = 1;         ///< may be driven so
inline constexpr std::uint16_t backward = 2;        ///< forward, times two
inline constexpr std::uint16_t forward_barred = 4;  ///< some turn out of this edge is forbidden
inline constexpr std::uint16_t backward_barred = 8; ///< forward_barred, times two
} // namespace link_flags

/// A turn at the end of the edge `from` that is forbidden. Sorted by both.
struct PackedTurn {
    std::uint32_t from;
    std::uint32_t to;
    friend auto operator<=>(const PackedTurn&, const PackedTurn&) = default;
};

} // namespace macadam
