#include "storage/store/server/importer/server_fusion.hpp"

#include "storage/postgres/copy_stream.hpp"
#include "storage/postgres/server_array.hpp"
#include "storage/store/rows/audit.hpp"
#include "storage/store/server/cells/cell_drives.hpp"
#include "storage/store/server/server_locks.hpp"
#include "storage/store/server/server_rows.hpp"
#include "storage/store/server/server_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <iterator>
#include <map>
#include <mutex>
#include <set>
#include <stop_token>
#include <utility>

namespace macadam {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t chunks_in_batch = 64;
constexpr auto look_again_after = 100ms; // for chunks that others hold

void pause(std::chrono::milliseconds time, const std::stop_token& stop) {
    std::mutex mutex;
    std::unique_lock lock{mutex};
    std::condition_variable_any stopped;
    stopped.wait_for(lock, stop, time, [] { return false; });
}

using States = std::map<std::int64_t, SegmentState>; ///< by row of the segment, without its key

States states_before(ServerConnection& server, const ChunkConditions& conditions) {
    States states;
    CopyReader rows{server,
                    fmt::format("(SELECT fid, {} FROM macadam.segment_state AS state"
                                " WHERE {} AND {})",
                                server_state_columns,
                                conditions.cells,
                                conditions.fids),
                    "segment_state",
                    1 + server_state_column_count};
    while (rows.next()) {
        states.emplace(rows.row().integer(0), server_state_in(rows.row(), 1, {}));
    }
    return states;
}

/// State to be written, with its cell.
struct NewState {
    std::int32_t cell;
    const FusedSegment* segment;
};

/// Value that is recorded in the audit; null: no pass of the segment is left.
struct NewNumber {
    std::int64_t fid;
    const SegmentState* state;
};

struct Difference {
    std::vector<std::int64_t> removed; ///< rows of states that go or are replaced
    std::vector<NewState> states;
    std::vector<NewNumber> numbers;
};

void add_difference(Difference& difference,
                    States& before,
                    std::int32_t cell,
                    const FusedChunk& fused) {
    for (const auto& segment : fused.segments) {
        auto now = segment.state;
        now.segment = {};
        const auto old = before.find(segment.fid);
        const bool is_new = old == before.end();
        if (is_new || old->second != now) {
            difference.states.push_back({cell, &segment});
            if (is_new || old->second.iri_um != now.iri_um || old->second.sd_um != now.sd_um ||
                old->second.passes != now.passes) {
                difference.numbers.push_back({segment.fid, &segment.state});
            }
            if (!is_new) {
                difference.removed.push_back(segment.fid);
            }
        }
        if (!is_new) {
            before.erase(old);
        }
    }
}

void write_states(ServerConnection& server,
                  const Difference& difference,
                  const ChunkConditions& conditions,
                  const ClassTable& classes) {
    if (!difference.removed.empty()) {
        server.rows(fmt::format("DELETE FROM macadam.segment_state WHERE {}"
                                " AND fid = ANY($1::bigint[])",
                                conditions.cells),
                    {array_of(difference.removed)});
    }
    if (!difference.states.empty()) {
        const auto& table = server_table("segment_state");
        CopyWriter writer{server, copy_target(table), static_cast<int>(table.columns.size())};
        for (const auto& [cell, segment] : difference.states) {
            write_server_state(writer, cell, segment->fid, segment->state, classes);
        }
        writer.finish();
    }
}

/// Adds the audit entry of an import, unless it has one.
void add_audit(ServerConnection& server, std::optional<std::int64_t>& audit) {
    if (!audit) {
        audit = server
                    .numbers("INSERT INTO macadam.audit (at, generation, what, detail) VALUES ($1,"
                             " coalesce((SELECT value FROM macadam.meta WHERE key = 'generation'),"
                             " '1')::bigint, 'import', 'new passes') RETURNING id",
                             {audit_time_now()})
                    .at(0);
    }
}

void write_numbers(ServerConnection& server,
                   const std::vector<NewNumber>& numbers,
                   std::int64_t audit) {
    std::vector<std::int64_t> fids;
    for (const auto& [fid, state] : numbers) {
        fids.push_back(fid);
    }
    server.rows("DELETE FROM macadam.state_change WHERE audit = $1 AND segment = ANY($2::bigint[])",
                {std::to_string(audit), array_of(fids)});
    CopyWriter writer{server, copy_target(server_table("state_change")), 5};
    for (const auto& [fid, state] : numbers) {
        std::optional<std::int64_t> iri_um, sd_um;
        if (state != nullptr) {
            iri_um = state->iri_um;
            sd_um = state->sd_um;
        }
        writer.add(fid, audit, iri_um, sd_um, std::int64_t{state != nullptr ? state->passes : 0});
    }
    writer.finish();
}

} // namespace

/// Chunks that are fused in one transaction.
struct ServerFusion::Batch {
    std::vector<std::int64_t> chunks; ///< rising
    std::vector<FusedChunk> fused;    ///< of each
    std::vector<std::int64_t> marked; ///< chunk of each mark that was read before the drives
    std::vector<std::int64_t> trips;  ///< trip of each
};

ServerFusion::ServerFusion(ServerConnection& server,
                           StoreConnection& image,
                           ImageRows& rows,
                           std::function<void()> expect_same)
    : server_{&server}, image_{&image}, rows_{&rows},
      expect_same_{std::move(expect_same)}, scratch_{server, image, rows}, marked_{server} {}

std::size_t
ServerFusion::fuse_marked(const Progress& progress, FusionRecord& record, BusyChunks busy) {
    std::vector<std::int64_t> segments;
    std::size_t done = 0;
    marked_.begin_round();
    while (!progress.stop.stop_requested()) {
        const auto waiting = marked_.next();
        if (waiting.empty()) {
            break;
        }
        const Progress part{
            .report = [&](std::size_t some, std::size_t of) { progress(done + some, done + of); },
            .stop = progress.stop};
        if (busy == BusyChunks::await) {
            fuse_all(waiting, part, record.audit, segments);
        } else {
            fuse_unlocked(waiting, part, record.audit, segments);
        }
        if (!progress.stop.stop_requested()) {
            marked_.advance();
            done += waiting.size();
        }
    }
    std::ranges::sort(segments);
    std::vector<std::int64_t> all;
    std::ranges::set_union(record.segments, segments, std::back_inserter(all));
    record.segments = std::move(all);
    return segments.size();
}

void ServerFusion::fuse_all(std::span<const std::int64_t> chunks,
                            const Progress& progress,
                            std::optional<std::int64_t>& audit,
                            std::vector<std::int64_t>& segments) {
    auto left = fuse_unlocked(chunks, progress, audit, segments);
    // Never in the queue of a lock: who waits there cannot be stopped, nor do anything else.
    while (!left.empty() && !progress.stop.stop_requested()) {
        pause(look_again_after, progress.stop);
        const auto done = chunks.size() - left.size();
        left = fuse_unlocked(
            left,
            {.report = [&](std::size_t some, std::size_t) { progress(done + some, chunks.size()); },
             .stop = progress.stop},
            audit,
            segments);
    }
}

std::vector<std::int64_t> ServerFusion::fuse_unlocked(std::span<const std::int64_t> chunks,
                                                      const Progress& progress,
                                                      std::optional<std::int64_t>& audit,
                                                      std::vector<std::int64_t>& segments) {
    std::vector<std::int64_t> left;
    for (std::size_t done = 0; done < chunks.size() && !progress.stop.stop_requested();) {
        const auto batch = chunks.subspan(done, std::min(chunks_in_batch, chunks.size() - done));
        const auto fused = fuse(batch, audit, segments);
        std::ranges::copy_if(batch, std::back_inserter(left), [&](std::int64_t chunk) {
            return !std::ranges::binary_search(fused, chunk);
        });
        done += batch.size();
        progress(done - left.size(), chunks.size());
    }
    return left;
}

std::vector<std::int64_t> ServerFusion::try_lock(std::span<const std::int64_t> chunks) {
    auto locked = server_->numbers("SELECT chunk FROM unnest($1::bigint[]) AS chunk"
                                   " WHERE pg_try_advisory_xact_lock(chunk)",
                                   {array_of(chunks)});
    std::ranges::sort(locked);
    return locked;
}

std::vector<std::int64_t> ServerFusion::fuse(std::span<const std::int64_t> chunks,
                                             std::optional<std::int64_t>& audit,
                                             std::vector<std::int64_t>& segments) {
    auto audit_now = audit; // that of this transaction
    ServerTransaction all{*server_};
    expect_same_();
    auto locked = try_lock(chunks); // a statement of its own: later ones see what came before it
    Batch batch;
    const auto marks = server_->numbers("SELECT chunk, trip FROM macadam.chunk_dirty"
                                        " WHERE chunk = ANY($1::bigint[]) ORDER BY chunk",
                                        {array_of(locked)});
    for (std::size_t i = 0; i + 1 < marks.size(); i += 2) {
        if (batch.chunks.empty() || batch.chunks.back() != marks[i]) {
            batch.chunks.push_back(marks[i]);
        }
        batch.marked.push_back(marks[i]);
        batch.trips.push_back(marks[i + 1]);
    }
    std::set<std::int32_t> cells;
    bool elsewhere = false;
    if (!batch.chunks.empty()) {
        for (const auto chunk : batch.chunks) {
            cells.insert(rows_->place_of(chunk).cell);
        }
        share_cells(*server_, cells);
        batch.fused = scratch_.fused(batch.chunks);
        write(batch, audit_now);
        elsewhere = are_elsewhere(*server_, cells);
        if (!elsewhere) {
            remove_marks(batch);
        }
    }
    all.commit();
    audit = audit_now;
    if (elsewhere) {
        remove_marks_once_kept(batch, cells);
    }
    for (const auto& chunk : batch.fused) {
        for (const auto& segment : chunk.segments) {
            segments.push_back(segment.fid);
        }
    }
    return locked;
}

void ServerFusion::write(const Batch& batch, std::optional<std::int64_t>& audit) {
    const auto conditions = conditions_of(batch.chunks, *rows_);
    auto before = states_before(*server_, conditions);
    Difference difference;
    for (std::size_t i = 0; i < batch.chunks.size(); ++i) {
        add_difference(difference, before, rows_->place_of(batch.chunks[i]).cell, batch.fused[i]);
    }
    for (const auto& [fid, state] : before) { // no pass of them is left
        difference.removed.push_back(fid);
        difference.numbers.push_back({fid, nullptr});
    }
    write_states(*server_, difference, conditions, image_->classes());
    if (!difference.numbers.empty()) {
        add_audit(*server_, audit);
        write_numbers(*server_, difference.numbers, *audit);
    }
    write_alignments(batch);
    server_->rows("INSERT INTO macadam.chunk_change SELECT unnest($1::bigint[])"
                  " ON CONFLICT (chunk) DO UPDATE SET changed = excluded.changed",
                  {array_of(batch.chunks)});
}

void ServerFusion::write_alignments(const Batch& batch) {
    server_->rows("DELETE FROM macadam.chunk_state WHERE chunk = ANY($1::bigint[])",
                  {array_of(batch.chunks)});
    CopyWriter writer{*server_, copy_target(server_table("chunk_state")), 6};
    for (std::size_t i = 0; i < batch.chunks.size(); ++i) {
        const auto& found = batch.fused[i].alignment;
        if (found.drives > 0) {
            writer.add(batch.chunks[i],
                       found.drives,
                       found.found,
                       found.beyond_reach,
                       found.moved_far,
                       std::int64_t{found.middle_lag_cm});
        }
    }
    writer.finish();
}

/// Marks that came later stay: their drives may have been missed.
void ServerFusion::remove_marks(const Batch& batch) {
    server_->rows("DELETE FROM macadam.chunk_dirty WHERE chunk = ANY($1::bigint[])"
                  " AND (chunk, trip) IN (SELECT * FROM unnest($2::bigint[], $3::bigint[]))",
                  {array_of(batch.chunks), array_of(batch.marked), array_of(batch.trips)});
}

void ServerFusion::remove_marks_once_kept(const Batch& batch, const std::set<std::int32_t>& cells) {
    ServerTransaction all{*server_};
    expect_same_();
    await_standbys(*server_, cells);
    remove_marks(batch);
    all.commit();
}

} // namespace macadam
