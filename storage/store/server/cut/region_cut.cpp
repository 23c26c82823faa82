#include "storage/store/server/cut/region_cut.hpp"

#include "estimator/common/error.hpp"
#include "mapping/background/background_levels.hpp"
#include "mapping/geometry/antimeridian.hpp"
#include "mapping/geometry/area.hpp"
#include "mapping/tiles/tile_grid.hpp"
#include "storage/atomic/atomic_file_set.hpp"
#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/postgres/server_array.hpp"
#include "storage/store/rows/segment_query.hpp"
#include "storage/store/server/copy/new_copy.hpp"
#include "storage/store/server/cut/cut_down.hpp"
#include "storage/store/server/reader/chunk_choice.hpp"
#include "storage/store/server/server_digest.hpp"
#include "storage/store/server/server_locks.hpp"
#include "storage/store/server/server_schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <set>
#include <span>
#include <vector>

namespace macadam {
namespace {

std::vector<std::int64_t> ways_of(ServerConnection& server, std::span<const ServerChunk> chunks) {
    return server.numbers(
        fmt::format("SELECT DISTINCT segment.way_id FROM {} JOIN macadam.segment ON segment.cell ="
                    " wanted.cell AND segment.fid = wanted.chunk",
                    wanted_chunks(chunks)));
}

/// Other chunks of ways.
std::vector<ServerChunk> other_chunks(ServerConnection& server,
                                      std::span<const ServerChunk> chunks,
                                      const std::string& ways) {
    const auto numbers = server.numbers("SELECT DISTINCT cell, chunk FROM macadam.segment"
                                        " WHERE way_id = ANY($1::bigint[]) ORDER BY cell, chunk",
                                        {ways});
    std::vector<ServerChunk> all, others;
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
        all.push_back({static_cast<std::int32_t>(numbers[i]), numbers[i + 1]});
    }
    std::ranges::set_difference(all, chunks, std::back_inserter(others));
    return others;
}

/// Ways of which a segment may have a point of these ways.
std::vector<std::int64_t> ways_near(ServerConnection& server, const std::string& ways) {
    return server.numbers(
        fmt::format("SELECT DISTINCT near.way_id FROM (SELECT {0}.ST_Expand({0}.ST_Extent(geom),"
                    " 1e-6) AS box FROM macadam.segment WHERE way_id = ANY($1::bigint[])"
                    " GROUP BY way_id) AS kept CROSS JOIN LATERAL (SELECT way_id FROM"
                    " macadam.segment WHERE geom OPERATOR({0}.&&)"
                    " {0}.ST_SetSRID(kept.box::{0}.geometry, 4326) OFFSET 0) AS near",
                    postgis_schema(server)),
        {ways});
}

GeoBox box_of(const SegmentFilter& place) {
    return place.box ? *place.box : place.area->box();
}

/// Condition for rows of table background in a box on the globe.
std::string tiles_in(const GeoBox& box) {
    std::string any;
    for (const auto& level : background_levels) {
        const auto tiles = tiles_of(box, level.zoom);
        any += fmt::format("{}(zoom = {} AND tile_x BETWEEN {} AND {} AND tile_y BETWEEN {} AND "
                           "{})",
                           any.empty() ? "" : " OR ",
                           level.zoom,
                           tiles.first_x,
                           tiles.last_x,
                           tiles.first_y,
                           tiles.last_y);
    }
    return any;
}

/// Condition for rows of table place in a box on the globe.
std::string places_in(const GeoBox& box) {
    const auto e7 = [](double deg) { return std::llround(deg * 1e7); };
    return fmt::format("lat_e7 BETWEEN {} AND {} AND lon_e7 BETWEEN {} AND {}",
                       e7(box.south_deg),
                       e7(box.north_deg),
                       e7(box.west_deg),
                       e7(box.east_deg));
}

/// Fills a file with chunks and what cut_down() needs of the roads around.
void fill_around(ServerConnection& server,
                 RowsFromServer& rows,
                 Database& file,
                 std::span<const ServerChunk> chunks,
                 const Region& region) {
    const auto ways = array_of(ways_of(server, chunks));
    const auto others = other_chunks(server, chunks, ways);
    PartContent content{.passes = true,
                        .publications = rows.privacy() == PrivacyProfile::crowd,
                        .roads_alone = others};
    content.others = [&] {
        const auto near = array_of(ways_near(server, ways));
        rows.copy_rows(server_table("way"), fmt::format("way_id = ANY('{}'::bigint[])", near));
        for (const auto* const table : {"road_ref", "forgotten", "publication"}) {
            rows.copy_rows(server_table(table));
        }
        constexpr double margin_m = 5000; // maps show some ground beside the outermost roads
        for (const auto& part : parts_on_globe(grown_over(box_of(region.place), margin_m))) {
            rows.copy_rows(server_table("background"), tiles_in(part));
            rows.copy_rows(server_table("place"), places_in(part));
        }
    };
    fill_part(rows, file, chunks, content);
}

/// Chunks of which a segment lies in a place.
std::vector<ServerChunk>
chunks_in(Database& file, std::span<const ServerChunk> chunks, const SegmentFilter& place) {
    const PlaceCondition condition{place};
    std::set<std::int64_t> found;
    std::vector<GeoPoint> line;
    auto select = file.prepare("SELECT strip, geom FROM segment");
    while (select.step()) {
        put_line_of_geometry(select.blob(1), line);
        if (!line.empty() && condition.holds_for(line)) {
            found.insert(select.integer(0));
        }
    }
    std::vector<ServerChunk> in_place;
    std::ranges::copy_if(chunks, std::back_inserter(in_place), [&](const ServerChunk& chunk) {
        return found.contains(chunk.row);
    });
    return in_place;
}

[[noreturn]] void refuse_no_road(ServerConnection& server, const Region& region) {
    const auto row = server
                         .rows(fmt::format("SELECT {0}.ST_XMin(box), {0}.ST_YMin(box),"
                                           " {0}.ST_XMax(box), {0}.ST_YMax(box) FROM"
                                           " (SELECT {0}.ST_Extent(geom) AS box FROM"
                                           " macadam.segment) AS extent",
                                           postgis_schema(server)))
                         .at(0);
    throw InputError{fmt::format("{}: no road lies in {}; its roads lie in the box {},{},{},{}",
                                 server.address(),
                                 region.words,
                                 row[0].value_or("-"),
                                 row[1].value_or("-"),
                                 row[2].value_or("-"),
                                 row[3].value_or("-"))};
}

} // namespace

StoreCopy cut_from_server(const std::string& address,
                          const Region& region,
                          const std::filesystem::path& file,
                          const Progress& progress) {
    expect_new_file(file);
    ServerConnection server{address};
    stop_writers(server);
    server.begin(true);
    see_all_cells(server);
    expect_server_schema(server);
    auto place = region.place;
    place.with_state_only = false;
    const auto near = chunks_for(server, place);
    if (near.empty()) {
        refuse_no_road(server, region);
    }
    AtomicFileSet whole{file};
    Database database{whole.main_file(), Database::Access::create, file};
    RowsFromServer rows{server, database, progress};
    fill_around(server, rows, database, near, region);
    const auto chunks = chunks_in(database, near, place);
    if (chunks.empty()) {
        refuse_no_road(server, region);
    }
    std::vector<std::int64_t> first_rows;
    std::ranges::transform(chunks, std::back_inserter(first_rows), &ServerChunk::row);
    cut_down(database, first_rows, fmt::format("{} of {}", region.words, address), progress);
    return finish_copy(server,
                       database,
                       whole,
                       digest_of_server(server, rows.chunk_size(), progress, chunks),
                       progress);
}

} // namespace macadam
