#pragma once

#include "estimator/common/geo.hpp"
#include "mapping/network/network_records.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace macadam {

/// Kinds of features below the roads of a map, from the lowest to the topmost layer. The numbers
/// are stored.
enum class BackgroundKind : std::uint8_t {
    built_up = 0, ///< residential, commercial and industrial land
    meadow = 1,   ///< meadows, grassland, orchards
    park = 2,     ///< parks, cemeteries, golf courses
    forest = 3,
    water = 4,  ///< lakes, wide rivers, basins
    river = 5,  ///< rivers and canals along their middle
    stream = 6, ///< along its middle
    building = 7,
    railway = 8,
    siding = 9, ///< yards, sidings and spurs of a railway
};
inline constexpr std::size_t background_kinds = 10;

/// Tests for kinds that are lines; all others are areas.
constexpr bool is_line_kind(BackgroundKind kind) {
    return kind == BackgroundKind::river || kind == BackgroundKind::stream ||
           kind == BackgroundKind::railway || kind == BackgroundKind::siding;
}

/// An area or a line on the ground.
struct BackgroundFeature {
    BackgroundKind kind;
    /// Of a line one path of two or more points; of an area its outer ring, then its holes, each of
    /// three or more points in any direction, without a repeated last one.
    std::vector<std::vector<PackedPoint>> paths;
};

/// Importance of a place's name. The numbers are stored.
enum class PlaceRank : std::uint8_t { city = 0, town = 1, village = 2, suburb = 3 };
inline constexpr std::size_t place_ranks = 4;

struct PlaceName {
    std::string name; ///< UTF-8
    PlaceRank rank;
    GeoPoint position;
    std::int64_t population = 0; ///< 0: unknown
};

/// Number of a road, such as "A 14" or "L191;L192", as on its signs.
struct RoadRef {
    std::int64_t way_id;
    std::string ref; ///< UTF-8
};

/// Receivers of a background as it is read.
struct BackgroundSink {
    std::function<void(const BackgroundFeature&)> feature;
    std::function<void(const PlaceName&)> place;
    std::function<void(const RoadRef&)> road_ref;
};

/// Reads a background into a sink.
using BackgroundSource = std::function<void(const BackgroundSink&)>;

} // namespace macadam
