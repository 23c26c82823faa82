#include "storage/store/background/background_rows.hpp"

#include "estimator/common/error.hpp"
#include "mapping/background/background_tiling.hpp"
#include "mapping/geometry/antimeridian.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

constexpr std::size_t max_text_bytes = 255; // of names and numbers
constexpr double per_deg = Unpacked::per_deg;

[[noreturn]] void refuse(const Database& database, const std::string& what) {
    throw InputError{fmt::format(
        "{}: {}; the database was modified by another program", database.file().string(), what)};
}

/// Sorts places: cities first, of equal rank the larger, then by name.
void insert_places(Database& database, std::vector<PlaceName> places) {
    std::sort(places.begin(), places.end(), [](const PlaceName& a, const PlaceName& b) {
        return std::tuple{a.rank, -a.population, std::string_view{a.name}, a.position.lat_deg} <
               std::tuple{b.rank, -b.population, std::string_view{b.name}, b.position.lat_deg};
    });
    auto insert = database.prepare("INSERT INTO place VALUES (NULL, ?, ?, ?, ?, ?)");
    for (const auto& place : places) {
        const auto at = packed(place.position);
        insert.run(place.name,
                   std::int64_t{static_cast<std::uint8_t>(place.rank)},
                   std::int64_t{at.lat_e7},
                   std::int64_t{at.lon_e7},
                   place.population);
    }
}

/// Condition that holds in any part of a box on the globe.
template <typename Condition>
std::string in_any_part(const GeoBox& box, Condition condition) {
    std::string any;
    for (const auto& part : parts_on_globe(box)) {
        any += fmt::format("{}({})", any.empty() ? "" : " OR ", condition(part));
    }
    return any;
}

} // namespace

GeoBox background_box(const RoadNetwork& roads) {
    constexpr double margin_m = 5000;
    return grown(extent_of(roads), margin_m);
}

std::string tiles_in(const GeoBox& box) {
    return in_any_part(box, [](const GeoBox& part) {
        std::string any;
        for (const auto& level : background_levels) {
            const auto tiles = tiles_of(part, level.zoom);
            any += fmt::format("{}(zoom = {} AND tile_x BETWEEN {} AND {} AND tile_y BETWEEN {}"
                               " AND {})",
                               any.empty() ? "" : " OR ",
                               level.zoom,
                               tiles.first_x,
                               tiles.last_x,
                               tiles.first_y,
                               tiles.last_y);
        }
        return any;
    });
}

std::string places_in(const GeoBox& box) {
    return in_any_part(box, [](const GeoBox& part) {
        const auto south_west = packed({part.south_deg, part.west_deg});
        const auto north_east = packed({part.north_deg, part.east_deg});
        return fmt::format("lat_e7 BETWEEN {} AND {} AND lon_e7 BETWEEN {} AND {}",
                           south_west.lat_e7,
                           north_east.lat_e7,
                           south_west.lon_e7,
                           north_east.lon_e7);
    });
}

BackgroundSize
replace_background(Database& database, const GeoBox& box, const BackgroundSource& source) {
    database.run("DELETE FROM background; DELETE FROM place; DELETE FROM road_ref");
    if (!source) {
        return {};
    }
    auto insert_tile = database.prepare("INSERT INTO background VALUES (?, ?, ?, ?, ?)");
    auto insert_ref = database.prepare("INSERT OR IGNORE INTO road_ref SELECT ?1, ?2 WHERE EXISTS "
                                       "(SELECT 1 FROM way WHERE way_id = ?1)");
    std::map<TileId, std::int64_t> parts;
    std::vector<PlaceName> places;
    BackgroundTiling tiling{[&](const TileId& tile, std::string_view pieces) {
        insert_tile.run(std::int64_t{tile.zoom},
                        std::int64_t{tile.x},
                        std::int64_t{tile.y},
                        parts[tile]++,
                        Blob{pieces});
    }};
    source({.feature = [&](const BackgroundFeature& feature) { tiling.add(feature, box); },
            .place = [&](const PlaceName& place) { places.push_back(place); },
            .road_ref = [&](const RoadRef& road) { insert_ref.run(road.way_id, road.ref); }});
    tiling.finish();
    insert_places(database, std::move(places));
    return background_size(database);
}

BackgroundSize background_size(Database& database) {
    return {.tiles = database.number("SELECT count(*) FROM background"),
            .bytes = database.number("SELECT coalesce(sum(length(pieces)), 0) FROM background"),
            .places = database.number("SELECT count(*) FROM place"),
            .road_refs = database.number("SELECT count(*) FROM road_ref")};
}

std::vector<BackgroundTile>
read_background_tiles(Database& database, const BackgroundLevel& level, const GeoBox& box) {
    const auto range = tiles_of(box, level.zoom);
    auto select = database.prepare(
        "SELECT tile_x, tile_y, pieces FROM background WHERE zoom = ? AND tile_x BETWEEN ? AND ? "
        "AND tile_y BETWEEN ? AND ? ORDER BY tile_x, tile_y, part");
    select.bind(std::int64_t{level.zoom},
                std::int64_t{range.first_x},
                std::int64_t{range.last_x},
                std::int64_t{range.first_y},
                std::int64_t{range.last_y});
    std::vector<BackgroundTile> tiles;
    while (select.step()) {
        const TileId tile{level.zoom,
                          static_cast<std::uint32_t>(select.integer(0)),
                          static_cast<std::uint32_t>(select.integer(1))};
        if (tiles.empty() || tiles.back().tile != tile) {
            tiles.push_back({tile, {}});
        }
        tiles.back().pieces += select.blob(2);
    }
    return tiles;
}

void visit_background_rows(
    Database& database,
    const std::function<void(const TileId& tile, std::int64_t part, std::string_view pieces)>&
        visit) {
    auto select = database.prepare("SELECT zoom, tile_x, tile_y, part, pieces FROM background "
                                   "ORDER BY zoom, tile_x, tile_y, part");
    while (select.step()) {
        visit({static_cast<std::uint8_t>(select.integer(0)),
               static_cast<std::uint32_t>(select.integer(1)),
               static_cast<std::uint32_t>(select.integer(2))},
              select.integer(3),
              select.blob(4));
    }
}

std::vector<PlaceName> read_place_names(Database& database, const GeoBox& box) {
    const auto south_west = packed({box.south_deg, box.west_deg});
    const auto north_east = packed({box.north_deg, box.east_deg});
    auto select =
        database.prepare("SELECT name, rank, lat_e7, lon_e7, population FROM place "
                         "WHERE lat_e7 BETWEEN ? AND ? AND lon_e7 BETWEEN ? AND ? ORDER BY id");
    select.bind(std::int64_t{south_west.lat_e7},
                std::int64_t{north_east.lat_e7},
                std::int64_t{south_west.lon_e7},
                std::int64_t{north_east.lon_e7});
    std::vector<PlaceName> places;
    while (select.step()) {
        const auto rank = select.integer(1);
        auto name = select.text(0);
        if (rank < 0 || rank >= std::int64_t{place_ranks}) {
            refuse(database, fmt::format("a place has rank {}", rank));
        }
        if (name.size() > max_text_bytes) {
            refuse(database, fmt::format("the name of a place has {} bytes", name.size()));
        }
        places.push_back({std::move(name),
                          static_cast<PlaceRank>(rank),
                          {static_cast<double>(select.integer(2)) / per_deg,
                           static_cast<double>(select.integer(3)) / per_deg},
                          select.integer(4)});
    }
    return places;
}

std::vector<RoadRef> read_road_refs(Database& database) {
    auto select = database.prepare("SELECT way_id, ref FROM road_ref ORDER BY way_id");
    std::vector<RoadRef> roads;
    while (select.step()) {
        roads.push_back({select.integer(0), select.text(1)});
        if (roads.back().ref.size() > max_text_bytes) {
            refuse(database,
                   fmt::format("the number of way {} has {} bytes",
                               roads.back().way_id,
                               roads.back().ref.size()));
        }
    }
    return roads;
}

} // namespace macadam
