#pragma once

#include "estimator/common/geo.hpp"

#include <cstdint>
#include <ranges>
#include <span>

namespace macadam {

// Layout of a RoadNetwork in memory and in its file: plain records without padding, read in place.

/// A position on a grid of 1e-7 degrees, OSM's own: 1.1 cm of latitude.
struct PackedPoint {
    std::int32_t lat_e7;
    std::int32_t lon_e7;
    friend bool operator==(const PackedPoint&, const PackedPoint&) = default;
};

/// Returns the nearest grid position.
PackedPoint packed(const GeoPoint& place);

struct Unpacked {
    static constexpr double per_deg = 1e7;
    static constexpr double per_m = 1000;

    GeoPoint operator()(const PackedPoint& point) const {
        return {point.lat_e7 / per_deg, point.lon_e7 / per_deg};
    }
    double operator()(std::uint32_t length_mm) const { return length_mm / per_m; }
};

/// Positions and lengths, unpacked on access: ranges with [], size, front, back.
using PointRange = std::ranges::transform_view<std::span<const PackedPoint>, Unpacked>;
using LengthRange = std::ranges::transform_view<std::span<const std::uint32_t>, Unpacked>;

/// First point, link and turn rule of a way; each range ends where the next way's begins.
struct PackedWay {
    std::int64_t id;
    std::uint32_t first_point;
    std::uint32_t first_link;
    std::uint32_t first_turn;
    std::uint32_t name; ///< text number, as is highway
    std::uint32_t highway;
    std::uint16_t speed_limit_cmps; ///< as signposted; 0: unknown
    std::uint8_t oneway;
    std::uint8_t zero;
};
static_assert(sizeof(PackedWay) == 32);

/// A link of a way. Its last point is the first of the next link, or the last of the way.
struct PackedLink {
    std::uint32_t way;
    std::uint32_t from; ///< node, as is to
    std::uint32_t to;
    std::uint32_t first_point; ///< index into all points
    std::uint32_t first_segment;
    std::uint32_t length_mm;
    std::uint16_t speed_limit_cmps; ///< signposted or usual
    std::uint16_t flags;
};
static_assert(sizeof(PackedLink) == 28);

namespace link_flags {
inline constexpr std::uint16_t forward = 1;         ///< drivable in this direction
inline constexpr std::uint16_t backward = 2;        ///< forward, times two
inline constexpr std::uint16_t forward_barred = 4;  ///< some turn from this edge is forbidden
inline constexpr std::uint16_t backward_barred = 8; ///< forward_barred, times two
} // namespace link_flags

/// A forbidden turn at the end of the edge `from`. Sorted by both.
struct PackedTurn {
    std::uint32_t from;
    std::uint32_t to;
    friend auto operator<=>(const PackedTurn&, const PackedTurn&) = default;
};

} // namespace macadam
