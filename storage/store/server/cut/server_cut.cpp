#include "storage/store/server/cut/server_cut.hpp"

#include "storage/atomic/atomic_file_set.hpp"
#include "storage/atomic/temporary_folder.hpp"
#include "storage/postgres/server_array.hpp"
#include "storage/store/background/background_rows.hpp"
#include "storage/store/copy/cut_out.hpp"
#include "storage/store/server/copy/new_copy.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/reader/chunk_choice.hpp"
#include "storage/store/server/server_digest.hpp"
#include "storage/store/server/server_locks.hpp"
#include "storage/store/server/server_schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <span>
#include <unordered_set>
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
                    " {0}.ST_SetSRID(kept.box::{0}.geometry, 4326) OFFSET 0) AS near"
                    " ORDER BY near.way_id",
                    postgis_schema(server)),
        {ways});
}

/// Fetches a part into a file: chunks, and what cut_out() needs of the roads around.
/// \returns the ways around.
std::vector<std::int64_t> fetch_part(ServerConnection& server,
                                     RowsFromServer& rows,
                                     Database& file,
                                     std::span<const ServerChunk> chunks,
                                     const GeoBox& ground) {
    const auto ways = array_of(ways_of(server, chunks));
    auto around = ways_near(server, ways);
    const auto others = other_chunks(server, chunks, ways);
    PartContent content{.passes = true, .publications = true, .roads_alone = others};
    content.others = [&] {
        rows.copy_rows(server_table("way"),
                       fmt::format("way_id = ANY('{}'::bigint[])", array_of(around)));
        for (const auto* const table : {"road_ref", "forgotten", "publication"}) {
            rows.copy_rows(server_table(table));
        }
        rows.copy_rows(server_table("background"), tiles_in(ground));
        rows.copy_rows(server_table("place"), places_in(ground));
    };
    fill_part(rows, file, chunks, content);
    return around;
}

/// Those of some chunks of a server that are in a file.
std::vector<ServerChunk> chunks_among(std::span<const ServerChunk> chunks,
                                      std::span<const ChunkRows> in_file) {
    std::unordered_set<std::int64_t> rows;
    for (const auto& chunk : in_file) {
        rows.insert(chunk.first);
    }
    std::vector<ServerChunk> among;
    std::ranges::copy_if(chunks, std::back_inserter(among), [&](const ServerChunk& chunk) {
        return rows.contains(chunk.row);
    });
    return among;
}

[[noreturn]] void refuse_no_road(ServerConnection& server, const Region& region) {
    const auto box = server
                         .rows(fmt::format("SELECT {0}.ST_XMin(box) || ',' || {0}.ST_YMin(box) ||"
                                           " ',' || {0}.ST_XMax(box) || ',' || {0}.ST_YMax(box)"
                                           " FROM (SELECT {0}.ST_Extent(geom) AS box FROM"
                                           " macadam.segment) AS extent",
                                           postgis_schema(server)))
                         .at(0)
                         .at(0);
    refuse_empty_region(server.address(), region, box.value_or("-"));
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
    const auto ground = ground_of(region);
    const TemporaryFolder folder{file};
    const auto part = folder.path() / "part.gpkg";
    Database fetched{part, Database::Access::create, address};
    RowsFromServer rows{server, fetched, progress};
    const auto around = fetch_part(server, rows, fetched, near, ground);
    const auto key = key_of_copy(fetched);
    fetched.close();

    StoreConnection source{part, Database::Access::read, {}, address};
    const auto chunks = chunks_in(source, region);
    if (chunks.empty()) {
        refuse_no_road(server, region);
    }
    const auto digest =
        digest_of_server(server, rows.chunk_size(), progress, chunks_among(near, chunks));
    server.commit();
    AtomicFileSet whole{file};
    Database database{whole.main_file(), Database::Access::create, file};
    cut_out(source,
            {.chunks = chunks,
             .ways_around = around,
             .ground = ground,
             .from = fmt::format("{} of {}", region.words, address)},
            database,
            progress);
    auto copy = finish_copy(database, whole, digest, key, progress);
    copy.by_superuser = server.is_superuser();
    return copy;
}

} // namespace macadam
