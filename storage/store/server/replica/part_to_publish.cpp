#include "storage/store/server/replica/part_to_publish.hpp"

#include "mapping/privacy/release_batches.hpp"
#include "storage/postgres/server_array.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace macadam {
namespace {

constexpr std::int64_t longest_hold = 3; // in publications, as for files

/// Operations that let no pass wait anew where nobody drives.
constexpr const char* harmless_operations =
    "('import', 'publish', 'forget', 'calibrate', 'background')";

/// Row of the last trip of the publication since which what may be published was driven.
std::optional<std::int64_t> trip_before_changes(ServerConnection& server) {
    const auto last = server.number("SELECT coalesce(max(number), 0) FROM macadam.publication");
    const auto since = std::to_string(std::max(std::int64_t{1}, last - longest_hold));
    const auto noted =
        server.numbers("SELECT max(id) FROM macadam.audit WHERE what = 'publish'"
                       " AND detail = 'publication ' || $1 HAVING max(id) IS NOT NULL",
                       {since});
    if (last == 0 || noted.empty() ||
        server.numbers(fmt::format("SELECT count(*) FROM macadam.audit WHERE id > $1"
                                   " AND what NOT IN {}",
                                   harmless_operations),
                       {std::to_string(noted.front())})
                .at(0) != 0) {
        return std::nullopt;
    }
    return server.numbers("SELECT last_trip FROM macadam.publication WHERE number = $1", {since})
        .at(0);
}

/// Chunks with enough cars that were driven since; those to be fused, of which it is not known
/// whether cars drove them; and those where a publication withdraws what roads are no more.
constexpr const char* chunks_to_publish =
    "WITH recent AS (SELECT DISTINCT cell, chunk FROM macadam.drive WHERE trip > $1),"
    " changed AS (SELECT chunk AS segment FROM macadam.chunk_dirty"
    " UNION SELECT fid FROM macadam.published_state JOIN macadam.valid_from ON segment = fid"
    " WHERE NOT EXISTS (SELECT FROM macadam.published_figure AS figure"
    " WHERE figure.segment = fid AND figure.until_ms > from_ms)"
    " UNION SELECT segment FROM macadam.published_event AS event WHERE NOT EXISTS"
    " (SELECT FROM macadam.published_state WHERE fid = event.segment))"
    " SELECT drive.cell, drive.chunk FROM recent JOIN macadam.drive USING (cell, chunk)"
    " JOIN macadam.trip ON trip.id = drive.trip WHERE trip.reference_ppm IS NULL"
    " GROUP BY drive.cell, drive.chunk HAVING count(DISTINCT trip.vehicle) >= $2"
    " UNION SELECT segment.cell, segment.chunk FROM changed JOIN macadam.segment"
    " ON segment.fid = changed.segment ORDER BY 1, 2";

std::string chunk_rows(const std::vector<ServerChunk>& chunks) {
    std::vector<std::int64_t> rows;
    std::ranges::transform(chunks, std::back_inserter(rows), &ServerChunk::row);
    return array_of(rows);
}

std::string cells_of(const std::vector<ServerChunk>& chunks) {
    std::vector<std::int32_t> cells;
    std::ranges::transform(chunks, std::back_inserter(cells), &ServerChunk::cell);
    return array_of(cells);
}

// Lengths in micrometres, so that sums depend on no order.

constexpr const char* shown_elsewhere =
    "SELECT count(*), coalesce(sum(floor((to_m - from_m) * 1e6 + 0.5)::bigint), 0)::bigint"
    " FROM macadam.published_state AS state JOIN macadam.segment ON segment.fid = state.fid"
    " WHERE segment.chunk NOT IN (SELECT unnest($1::bigint[]))";

/// A fused segment has passes of cars if its value says so; one that was resurfaced may have
/// others.
constexpr const char* left_elsewhere =
    "SELECT count(*), coalesce(sum(floor((to_m - from_m) * 1e6 + 0.5)::bigint), 0)::bigint"
    " FROM macadam.segment WHERE chunk NOT IN (SELECT unnest($1::bigint[]))"
    " AND NOT EXISTS (SELECT FROM macadam.published_state AS state WHERE state.fid = segment.fid)"
    " AND (EXISTS (SELECT FROM macadam.segment_state AS state WHERE state.cell = segment.cell"
    " AND state.fid = segment.fid AND state.passes > 0)"
    " OR (segment.fid IN (SELECT valid_from.segment FROM macadam.valid_from) AND EXISTS"
    " (SELECT FROM macadam.drive JOIN macadam.trip ON trip.id = drive.trip"
    " CROSS JOIN LATERAL macadam.passes_in(drive.body) AS pass"
    " WHERE drive.cell = segment.cell AND drive.chunk = segment.chunk"
    " AND trip.reference_ppm IS NULL AND pass.\"offset\" = segment.fid - segment.chunk)))";

PublishedPart published_part(ServerConnection& server, const std::vector<ServerChunk>& chunks) {
    PublishedPart part;
    std::ranges::transform(chunks, std::back_inserter(part.chunks), &ServerChunk::row);
    std::ranges::sort(part.chunks);
    part.last_segment = server.number("SELECT coalesce(max(fid), 0) FROM macadam.segment");
    part.trips = server.number("SELECT count(*) FROM macadam.trip WHERE reference_ppm IS NULL");
    part.cars = server.number("SELECT count(*) FROM macadam.vehicle");
    const auto total = [&](const char* sql) {
        const auto numbers = server.numbers(sql, {chunk_rows(chunks)});
        return PublishedTotal{numbers.at(0), numbers.at(1)};
    };
    part.shown_elsewhere = total(shown_elsewhere);
    part.left_elsewhere = total(left_elsewhere);
    return part;
}

} // namespace

std::optional<DatabasePart> part_to_publish(ServerConnection& server) {
    const auto last_trip = trip_before_changes(server);
    if (!last_trip) {
        return std::nullopt;
    }
    DatabasePart part{.chunks = chunks_in(server.numbers(
                          chunks_to_publish,
                          {std::to_string(*last_trip), std::to_string(ReleaseRule{}.min_cars)}))};
    part.trips = server.numbers("SELECT max(id) FROM macadam.trip HAVING max(id) IS NOT NULL");
    const auto rows = chunk_rows(part.chunks);
    part.trips_with_all_passes =
        server.numbers("SELECT id FROM macadam.trip WHERE reference_ppm IS NULL AND id IN"
                       " (SELECT trip FROM macadam.drive JOIN unnest($1::integer[], $2::bigint[])"
                       " AS held (cell, chunk) USING (cell, chunk)) ORDER BY id",
                       {cells_of(part.chunks), rows});
    part.other_chunks =
        chunks_in(server.numbers("SELECT DISTINCT cell, chunk FROM macadam.drive"
                                 " WHERE trip = ANY($1::bigint[]) AND chunk NOT IN"
                                 " (SELECT unnest($2::bigint[])) ORDER BY cell, chunk",
                                 {array_of(part.trips_with_all_passes), rows}));
    part.to_publish = published_part(server, part.chunks);
    return part;
}

} // namespace macadam
