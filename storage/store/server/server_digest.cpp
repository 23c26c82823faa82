#include "storage/store/server/server_digest.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/sha256.hpp"
#include "storage/postgres/copy_stream.hpp"
#include "storage/store/rows/digest_text.hpp"
#include "storage/store/server/server_rows.hpp"

#include <algorithm>
#include <optional>
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

void add_passes(Sha256& hash,
                ServerConnection& server,
                std::uint32_t segments_per_chunk,
                const Progress& progress) {
    CopyReader drives{server,
                      std::string{"(SELECT segment.way_id, segment.direction, segment.seq,"
                                  " trip.sha256, trip.reference_ppm IS NOT NULL, drive.body"
                                  " FROM macadam.drive"
                                  " JOIN macadam.segment ON segment.cell = drive.cell"
                                  " AND segment.fid = drive.chunk"
                                  " JOIN macadam.trip ON trip.id = drive.trip"} +
                          order_of_server_keys + ")",
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

void add_states(Sha256& hash, ServerConnection& server) {
    CopyReader states{server,
                      std::string{"(SELECT segment.way_id, segment.direction, segment.seq, "} +
                          server_state_columns +
                          " FROM macadam.segment_state AS state JOIN macadam.segment"
                          " ON segment.cell = state.cell AND segment.fid = state.fid" +
                          order_of_server_keys + ")",
                      "segment_state",
                      3 + server_state_column_count};
    while (states.next()) {
        hash.add(digest_line_of_state(
            server_state_in(states.row(), 3, segment_key_in(states.row(), 0))));
    }
}

void add_events(Sha256& hash, ServerConnection& server) {
    CopyReader searched{server,
                        "(SELECT trip.sha256 FROM macadam.event_search JOIN macadam.trip"
                        " ON trip.id = event_search.trip ORDER BY trip.sha256 COLLATE \"C\")",
                        "event_search",
                        1};
    while (searched.next()) {
        hash.add(digest_line_of_search(searched.row().bytes(0)));
    }
    constexpr int numbers = 8; // occurrence and those after it
    CopyReader events{
        server,
        std::string{"(SELECT segment.segment, trip.sha256, occurrence, kind, track, at_mm,"
                    " place_sd_mm, size_um, sd_um, length_mm FROM macadam.event"
                    " JOIN macadam.segment ON segment.fid = event.segment"
                    " JOIN macadam.trip ON trip.id = event.trip"} +
            order_of_server_keys + ", trip.sha256 COLLATE \"C\", occurrence, number)",
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
                             const Progress& progress) {
    Sha256 hash;
    add_passes(hash, server, segments_per_chunk, progress);
    add_states(hash, server);
    add_events(hash, server);
    return hash.hex();
}

} // namespace macadam
