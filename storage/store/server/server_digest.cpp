#include "storage/store/server/server_digest.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/sha256.hpp"
#include "storage/postgres/copy_stream.hpp"
#include "storage/store/rows/digest_text.hpp"
#include "storage/store/server/server_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <vector>

namespace macadam {
namespace {

/// Forward before backward, as the SQL of a file orders them.
constexpr const char* order_of_server_keys =
    " ORDER BY segment.way_id, segment.direction COLLATE \"C\" DESC, segment.seq";

struct ListedPass {
    std::string trip_sha256;
    bool is_reference;
    DrivePass pass;
};

void add_chunk(Sha256& hash, const SegmentKey& first, std::vector<ListedPass>& passes) {
    std::ranges::sort(passes, {}, [](const ListedPass& listed) {
        return std::tuple{
            listed.pass.offset, std::string_view{listed.trip_sha256}, listed.pass.pass.occurrence};
    });
    for (const auto& [trip, is_reference, pass] : passes) {
        const SegmentKey key{first.way_id, first.forward, first.index + pass.offset};
        hash.add(
            digest_line_of_pass(is_reference, name_of(key), trip, numbers_for_digest(pass.pass)));
    }
    passes.clear();
}

/// Sources of the rows over which a digest is, of all chunks or of some.
struct DigestSources {
    std::string drives = "macadam.drive";
    std::string states = "macadam.segment_state AS state JOIN macadam.segment"
                         " ON segment.cell = state.cell AND segment.fid = state.fid";
    std::string events = "macadam.event JOIN macadam.segment ON segment.fid = event.segment";
    std::string searches = "macadam.event_search"; ///< of trips
};

DigestSources sources_of(std::span<const ServerChunk> chunks, std::uint32_t segments_per_chunk) {
    const auto drives =
        wanted_chunks(chunks) +
        join_each("drive", "drive", "drive.cell = wanted.cell AND drive.chunk = wanted.chunk");
    return {drives,
            wanted_chunks(chunks) + join_states(segments_per_chunk),
            wanted_chunks(chunks) + join_segments(segments_per_chunk) +
                join_each("event", "event", "event.segment = segment.fid"),
            fmt::format("(SELECT DISTINCT drive.trip FROM {}) AS driven JOIN macadam.event_search"
                        " ON event_search.trip = driven.trip",
                        drives)};
}

void add_passes(Sha256& hash,
                ServerConnection& server,
                const DigestSources& sources,
                std::uint32_t segments_per_chunk,
                const Progress& progress) {
    CopyReader drives{server,
                      fmt::format("(SELECT segment.way_id, segment.direction, segment.seq,"
                                  " trip.sha256, trip.reference_ppm IS NOT NULL, drive.body"
                                  " FROM {} JOIN macadam.segment ON segment.cell = drive.cell"
                                  " AND segment.fid = drive.chunk"
                                  " JOIN macadam.trip ON trip.id = drive.trip {})",
                                  sources.drives,
                                  order_of_server_keys),
                      "drive",
                      6};
    std::optional<SegmentKey> chunk;
    std::vector<ListedPass> passes;
    while (drives.next()) {
        const auto& row = drives.row();
        const auto key = segment_key_in(row, 0);
        if (chunk && *chunk != key) {
            add_chunk(hash, *chunk, passes);
        }
        chunk = key;
        for (const auto& pass : server_passes_in(server, row.bytes(5), segments_per_chunk)) {
            passes.push_back({std::string{row.bytes(3)}, row.boolean(4), pass});
        }
        expect_no_stop(server, progress);
    }
    if (chunk) {
        add_chunk(hash, *chunk, passes);
    }
}

void add_states(Sha256& hash, ServerConnection& server, const DigestSources& sources) {
    CopyReader states{server,
                      fmt::format("(SELECT segment.way_id, segment.direction, segment.seq, {}"
                                  " FROM {} {})",
                                  server_state_columns,
                                  sources.states,
                                  order_of_server_keys),
                      "segment_state",
                      3 + server_state_column_count};
    while (states.next()) {
        hash.add(digest_line_of_state(
            server_state_in(states.row(), 3, segment_key_in(states.row(), 0))));
    }
}

void add_events(Sha256& hash, ServerConnection& server, const DigestSources& sources) {
    CopyReader searched{server,
                        fmt::format("(SELECT trip.sha256 FROM {} JOIN macadam.trip ON trip.id ="
                                    " event_search.trip ORDER BY trip.sha256 COLLATE \"C\")",
                                    sources.searches),
                        "event_search",
                        1};
    while (searched.next()) {
        hash.add(digest_line_of_search(searched.row().bytes(0)));
    }
    constexpr int numbers = 8; // occurrence and those after it
    CopyReader events{
        server,
        fmt::format("(SELECT segment.segment, trip.sha256, occurrence, kind, track, at_mm,"
                    " place_sd_mm, size_um, sd_um, length_mm FROM {}"
                    " JOIN macadam.trip ON trip.id = event.trip"
                    " {}, trip.sha256 COLLATE \"C\", occurrence, number)",
                    sources.events,
                    order_of_server_keys),
        "event",
        2 + numbers};
    while (events.next()) {
        DigestNumbers values;
        for (int column = 2; column < 2 + numbers; ++column) {
            values.push_back(events.row().known_integer(column));
        }
        hash.add(digest_line_of_event(events.row().bytes(0), events.row().bytes(1), values));
    }
}

} // namespace

std::string digest_of_server(ServerConnection& server,
                             std::uint32_t segments_per_chunk,
                             const Progress& progress,
                             const std::optional<std::span<const ServerChunk>>& chunks) {
    const auto sources = chunks ? sources_of(*chunks, segments_per_chunk) : DigestSources{};
    Sha256 hash;
    add_passes(hash, server, sources, segments_per_chunk, progress);
    add_states(hash, server, sources);
    add_events(hash, server, sources);
    return hash.hex();
}

} // namespace macadam
