#include "storage/store/publication/publication_work.hpp"

#include "estimator/common/error.hpp"
#include "mapping/privacy/drive_ends.hpp"
#include "mapping/privacy/network_blocks.hpp"
#include "mapping/privacy/published_event.hpp"
#include "mapping/privacy/published_state.hpp"
#include "mapping/privacy/release_batches.hpp"
#include "storage/sqlite/bulk_insert.hpp"
#include "storage/store/fusion/chunk_events.hpp"
#include "storage/store/fusion/chunk_states.hpp"
#include "storage/store/fusion/store_version.hpp"
#include "storage/store/publication/publication_rows.hpp"
#include "storage/store/rows/event_row.hpp"
#include "storage/store/rows/segment_row.hpp"
#include "storage/store/rows/segment_rowids.hpp"
#include "storage/store/schema/store_schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

namespace macadam {
namespace {

constexpr std::int64_t longest_hold = 3; // in publications

/// Passes in the first or last block of a drive: row of the segment, trip hash, occurrence.
using EndPasses = std::set<std::tuple<std::int64_t, std::string, std::uint32_t>>;

using TripRows = std::unordered_map<std::string, std::int64_t>; ///< by hash

TripRows rows_of_trips(Database& database) {
    auto select = database.prepare("SELECT sha256, id FROM trip WHERE reference_ppm IS NULL");
    TripRows rows;
    while (select.step()) {
        rows[select.text(0)] = select.integer(1);
    }
    return rows;
}

void expect_to_go_on(const Database& database, const Progress& progress) {
    if (progress.stop.stop_requested()) {
        throw InputError{
            fmt::format("{}: interrupted; the database is unchanged", database.file().string())};
    }
}

EndPasses end_passes_of(Database& database,
                        const NetworkBlocks& blocks,
                        const TripRows& trips,
                        const Progress& progress) {
    struct Row {
        std::int64_t fid;
        std::uint32_t occurrence;
    };
    auto select = database.prepare(
        "SELECT pass.segment, pass.occurrence, pass.t_ms, segment.way_id, segment.direction,"
        " segment.seq FROM pass CROSS JOIN segment ON segment.fid = pass.segment"
        " WHERE pass.trip = ? ORDER BY pass.t_ms, pass.segment");
    EndPasses ends;
    for (const auto& [sha256, trip] : trips) {
        expect_to_go_on(database, progress);
        std::vector<Row> rows;
        std::vector<BlockVisit> visits;
        for (select.bind(trip); select.step();) {
            rows.push_back({select.integer(0), static_cast<std::uint32_t>(select.integer(1))});
            visits.push_back({select.integer(2), blocks.block_of(key_in(select, 3))});
        }
        select.reset();
        const auto at_end = in_end_blocks(visits);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (at_end[i]) {
                ends.emplace(rows[i].fid, sha256, rows[i].occurrence);
            }
        }
    }
    return ends;
}

/// Published passes of a segment: those of all trips up to a row, except the pending ones.
struct PublishedUntil {
    std::int64_t last_trip = 0;
    std::set<std::pair<std::int64_t, std::uint32_t>> pending{}; ///< trip, occurrence
};

/// Passes of a segment, as indexes into those of the chunk.
struct SegmentPasses {
    std::int64_t fid;
    std::size_t first;
    std::size_t past;
    std::vector<std::size_t> pending; ///< unpublished ones
    Release release;                  ///< of the pending passes
};

class PublicationMaker {
public:
    PublicationMaker(Database& database, const PublicationWork& work, const Progress& progress)
        : work_{work}, blocks_{*work.roads}, trips_{rows_of_trips(database)},
          ends_{end_passes_of(database, blocks_, trips_, progress)}, states_{database},
          events_{database}, rows_{database, work.segments_per_chunk},
          number_{1 + database.number("SELECT coalesce(max(number), 0) FROM publication")},
          all_reaches_{reaches_of_all(database)}, before_{reach_of(database, number_ - 1)},
          rule_{.last_of_key = read_last_of_keys(database)},
          until_{database.prepare("SELECT last_trip FROM published_until WHERE segment = ?")},
          put_until_{database.prepare("INSERT INTO temp.staged_until VALUES (?, ?)")},
          pending_{
              database.prepare("SELECT trip, occurrence FROM published_pending WHERE segment = ?")},
          put_pending_{database.prepare("INSERT INTO temp.staged_pending VALUES (?, ?, ?)")},
          figures_{database.prepare(
              "SELECT coalesce(max(number), 0) FROM published_figure WHERE segment = ?")},
          first_figure_{
              database.prepare("SELECT min(publication) FROM published_figure WHERE segment = ?")},
          put_figure_{database.prepare("INSERT INTO temp.staged_figure VALUES"
                                       " (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")},
          put_chunk_{database.prepare("INSERT INTO temp.staged_chunk VALUES (?)")},
          put_event_{database.prepare("INSERT INTO temp.staged_event VALUES"
                                      " (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")},
          put_state_{database, "INSERT INTO temp.staged_state", state_column_count},
          last_trip_{database.number("SELECT coalesce(max(id), 0) FROM trip")} {
        for (std::int64_t hold = 0; hold <= longest_hold; ++hold) {
            reach_.push_back(reach_of(database, number_ - hold).last_trip);
        }
    }

    /// \returns the number of its segments with new values.
    std::size_t take_chunk(std::int64_t chunk) {
        auto passes = states_.passes_of_cars(chunk, work_.segments_per_chunk);
        remove_unpublishable(passes);
        const auto segments = segments_in(passes);
        const auto changed = std::ranges::count_if(segments, [](const SegmentPasses& segment) {
            return !segment.release.batches.empty();
        });
        if (changed > 0) {
            write(chunk, std::move(passes), segments);
        }
        return static_cast<std::size_t>(changed);
    }

    void flush() { put_state_.flush(); }

private:
    std::vector<SegmentPasses> segments_in(const std::vector<ChunkPass>& passes) {
        std::vector<SegmentPasses> segments;
        for (std::size_t first = 0; first < passes.size();) {
            std::size_t past = first;
            while (past < passes.size() && passes[past].fid == passes[first].fid) {
                ++past;
            }
            segments.push_back(segment_of(passes, first, past));
            first = past;
        }
        return segments;
    }

    SegmentPasses
    segment_of(const std::vector<ChunkPass>& passes, std::size_t first, std::size_t past) {
        const auto fid = passes[first].fid;
        const auto status = status_of(fid);
        const auto aged = aged_trip(passes[first].input.pass.segment);
        SegmentPasses segment{fid, first, past, {}, {}};
        std::vector<PendingPass> pending;
        for (auto i = first; i < past; ++i) {
            const auto& input = passes[i].input;
            const auto trip = trips_.at(input.trip_sha256);
            if (trip > status.last_trip || status.pending.contains({trip, input.pass.occurrence})) {
                segment.pending.push_back(i);
                pending.push_back({.vehicle = input.vehicle,
                                   .utc_ms = input.utc_ms,
                                   .is_new = trip > before_.last_trip,
                                   .has_aged = trip <= aged});
            }
        }
        segment.release = release(pending, rule_);
        return segment;
    }

    /// Publication status of a segment.
    PublishedUntil status_of(std::int64_t fid) {
        until_.bind(fid);
        PublishedUntil until;
        if (until_.step()) {
            until.last_trip = until_.integer(0);
            for (pending_.bind(fid); pending_.step();) {
                until.pending.emplace(pending_.integer(0),
                                      static_cast<std::uint32_t>(pending_.integer(1)));
            }
            pending_.reset();
        }
        until_.reset();
        return until;
    }

    /// Last trip of the publications before the map that brought the segment, whose passes are
    /// never published there: they would tell of cars beside what the segments of the earlier map
    /// showed. 0: there was none, or the segment is one of theirs with its batches.
    std::int64_t last_trip_before_map_of(std::int64_t fid) {
        PublicationReach last;
        for (const auto& reach : all_reaches_) {
            if (reach.last_segment < fid && reach.number > last.number) {
                last = reach;
            }
        }
        if (last.number > 0) {
            first_figure_.bind(fid).step();
            const auto first = first_figure_.known_integer(0);
            first_figure_.reset();
            return first && *first <= last.number ? 0 : last.last_trip;
        }
        return 0;
    }

    /// Removes what is never published: passes at the ends of drives, and those that publications
    /// of an earlier map considered.
    void remove_unpublishable(std::vector<ChunkPass>& passes) {
        std::optional<std::int64_t> fid;
        std::int64_t last_trip = 0;
        std::erase_if(passes, [&](const ChunkPass& pass) {
            if (fid != pass.fid) {
                fid = pass.fid;
                last_trip = last_trip_before_map_of(pass.fid);
            }
            const auto& input = pass.input;
            return ends_.contains({pass.fid, input.trip_sha256, input.pass.occurrence}) ||
                   (last_trip > 0 && trips_.at(input.trip_sha256) <= last_trip);
        });
    }

    /// Last trip that was stored one to three publications ago; the key draws the number for each
    /// block, so that segments which appear together do not reveal a single trip.
    std::int64_t aged_trip(const SegmentKey& segment) {
        const auto block = blocks_.block_of(segment);
        const auto [found, is_new] = aged_.try_emplace(block, 0);
        if (is_new) {
            const double drawn = work_.key->draw(fmt::format("{}", block), "hold", 1).front();
            const auto hold = 1 + static_cast<std::size_t>(drawn * longest_hold);
            found->second = reach_[hold];
        }
        return found->second;
    }

    void write(std::int64_t chunk,
               std::vector<ChunkPass> passes,
               const std::vector<SegmentPasses>& segments) {
        std::vector<bool> stays_pending(passes.size());
        for (const auto& segment : segments) {
            for (const auto i : segment.release.left) {
                stays_pending[segment.pending[i]] = true;
            }
            if (!segment.release.batches.empty()) {
                put_until(segment, passes);
            }
        }
        std::vector<ChunkPass> published_passes;
        std::vector<std::size_t> place(passes.size()); // in `published_passes`
        for (std::size_t i = 0; i < passes.size(); ++i) {
            place[i] = published_passes.size();
            if (!stays_pending[i]) {
                published_passes.push_back(std::move(passes[i]));
            }
        }
        put_chunk_.run(chunk);
        write_events(chunk, published_passes);
        states_.align_with_each_other(chunk, published_passes);
        for (const auto& segment : segments) {
            if (!segment.release.batches.empty()) {
                write_segment(segment, published_passes, place);
            }
        }
    }

    /// Stages the events of a chunk that enough cars report in published passes.
    void write_events(std::int64_t chunk, const std::vector<ChunkPass>& published_passes) {
        EventInputs inputs;
        events_.add(chunk, published_passes, inputs);
        std::int64_t number = 0;
        for (auto& event : fuse_events(std::move(inputs.reports), inputs.segments)) {
            if (const auto shown = published(std::move(event), rule_)) {
                write_published_event(put_event_, rows_.row_of(shown->segment), number++, *shown);
            }
        }
    }

    void put_until(const SegmentPasses& segment, const std::vector<ChunkPass>& passes) {
        put_until_.run(segment.fid, last_trip_);
        for (const auto i : segment.release.left) {
            const auto& input = passes[segment.pending[i]].input;
            put_pending_.run(
                segment.fid, trips_.at(input.trip_sha256), std::int64_t{input.pass.occurrence});
        }
    }

    void write_segment(const SegmentPasses& segment,
                       const std::vector<ChunkPass>& published_passes,
                       const std::vector<std::size_t>& place) {
        auto number = last_figure_of(segment.fid);
        for (const auto& batch : segment.release.batches) {
            std::vector<FusionInput> inputs;
            for (const auto i : batch.passes) {
                inputs.push_back(published_passes[place[segment.pending[i]]].input);
            }
            write_figure(segment.fid, ++number, batch, state_of(inputs));
        }
        std::vector<FusionInput> inputs;
        for (std::size_t i = place[segment.first];
             i < published_passes.size() && published_passes[i].fid == segment.fid;
             ++i) {
            inputs.push_back(published_passes[i].input);
        }
        write_state(put_state_, segment.fid, state_of(inputs), *work_.classes);
    }

    SegmentState state_of(const std::vector<FusionInput>& inputs) const {
        return published(fuse(inputs, states_.config()), inputs, rule_);
    }

    /// Number of a segment's last published figure; 0 if there is none.
    std::int64_t last_figure_of(std::int64_t fid) {
        figures_.bind(fid).step();
        const auto number = figures_.integer(0);
        figures_.reset();
        return number;
    }

    void write_figure(std::int64_t fid,
                      std::int64_t number,
                      const ReleaseBatch& batch,
                      const SegmentState& state) {
        const auto known = [](const std::optional<IriUm>& um) {
            return um ? std::optional<std::int64_t>{*um} : std::nullopt;
        };
        put_figure_.run(fid,
                        number,
                        number_,
                        batch.from_ms,
                        batch.until_ms,
                        state.iri_um,
                        state.sd_um,
                        state.low_um,
                        state.high_um,
                        known(state.left_um),
                        known(state.right_um),
                        state.centre_only,
                        std::int64_t{state.validity},
                        state.passes,
                        state.vehicles);
    }

    PublicationWork work_;
    NetworkBlocks blocks_;
    TripRows trips_;
    EndPasses ends_;
    ChunkFusion states_;
    ChunkEvents events_;
    SegmentRowids rows_;
    std::int64_t number_;
    std::vector<PublicationReach> all_reaches_; ///< of earlier publications
    PublicationReach before_;
    ReleaseRule rule_;
    std::vector<std::int64_t> reach_; ///< last trips, by number of publications ago; 0: no trip
    std::unordered_map<std::uint64_t, std::int64_t> aged_; ///< by block
    Statement until_;
    Statement put_until_;
    Statement pending_;
    Statement put_pending_;
    Statement figures_;
    Statement first_figure_;
    Statement put_figure_;
    Statement put_chunk_;
    Statement put_event_;
    BulkInsert put_state_;
    std::int64_t last_trip_;
};

} // namespace

std::size_t
stage_pending(Database& database, const PublicationWork& work, const Progress& progress) {
    auto chunks = driven_chunks(database);
    if (work.part != nullptr) {
        std::erase_if(chunks, [&](std::int64_t chunk) {
            return !std::ranges::binary_search(work.part->chunks, chunk);
        });
    }
    PublicationMaker maker{database, work, progress};
    std::size_t changed = 0;
    for (std::size_t done = 0; done < chunks.size();) {
        expect_to_go_on(database, progress);
        changed += maker.take_chunk(chunks[done]);
        progress(++done, chunks.size());
    }
    expect_to_go_on(database, progress);
    maker.flush();
    return changed;
}

} // namespace macadam
