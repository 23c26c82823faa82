#include "storage/store/fusion/dirty_fusion.hpp"

#include "estimator/common/error.hpp"
#include "storage/store/fusion/chunk_states.hpp"
#include "storage/store/fusion/staged_chunks.hpp"
#include "storage/store/fusion/store_version.hpp"
#include "storage/store/rows/audit.hpp"
#include "storage/store/rows/segment_row.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <iterator>
#include <map>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace macadam {
namespace {

using Clock = std::chrono::steady_clock;

// A waiting importer polls for the lock every 5 ms (lock_wait.cpp).
constexpr std::chrono::milliseconds longest_turn{200};
constexpr std::chrono::milliseconds pause_between_turns{10};

constexpr int max_tries = 3; // the last one under the write lock

// The rows of a chunk's segments are consecutive.
constexpr const char* last_of_chunk =
    "SELECT fid FROM segment WHERE fid >= ?1 AND fid < ?1 + ?2 AND strip = ?1"
    " ORDER BY fid DESC LIMIT 1";

constexpr const char* clean_segments =
    "DELETE FROM segment_dirty WHERE segment BETWEEN ? AND ? RETURNING segment";

constexpr const char* states_of_chunk =
    "SELECT fid, iri, iri_sd, passes FROM segment_state WHERE fid BETWEEN ? AND ?";

/// Values recorded when a state changes.
struct Number {
    IriUm iri_um;
    IriUm sd_um;
    std::int64_t passes;
    friend bool operator==(const Number&, const Number&) = default;
};
using Numbers = std::map<std::int64_t, Number>; ///< by row of the segment

IriUm um_of(double mm_per_m) {
    return static_cast<IriUm>(std::lround(mm_per_m * 1000));
}

/// Fuses dirty chunks within one transaction; between two, others may change the rules.
class DirtyChunkFusion {
public:
    DirtyChunkFusion(Database& database,
                     std::int64_t segments_per_chunk,
                     const ClassTable& classes,
                     std::optional<std::int64_t> audit)
        : database_{&database}, last_{database.prepare(last_of_chunk)}, clean_{database.prepare(
                                                                            clean_segments)},
          clean_chunk_{database.prepare("DELETE FROM strip_dirty WHERE strip = ?")},
          select_{database.prepare(states_of_chunk)}, insert_{database,
                                                              insert_state,
                                                              state_column_count},
          remove_{database.prepare("DELETE FROM segment_state WHERE fid = ?")},
          note_{database, "INSERT OR REPLACE INTO state_change", 5},
          insert_chunk_{
              database.prepare("INSERT OR REPLACE INTO strip_state VALUES (?, ?, ?, ?, ?, ?)")},
          remove_chunk_{database.prepare("DELETE FROM strip_state WHERE strip = ?")},
          segments_in_chunk_{segments_per_chunk}, classes_{&classes}, audit_{audit} {}

    /// \param fused  result, if already known.
    void clean_chunk(std::int64_t chunk, const std::optional<FusedChunk>& fused) {
        const auto last = last_of(chunk);
        const auto cleaned_before = cleaned_.size();
        for (clean_.bind(chunk, last); clean_.step();) {
            cleaned_.push_back(clean_.integer(0));
        }
        clean_.reset();
        clean_chunk_.run(chunk);
        if (cleaned_.size() > cleaned_before || database_->changes() > 0) {
            if (fused) {
                write(chunk, last, *fused);
            } else {
                write(chunk, last, states().of(chunk, segments_in_chunk_));
            }
        }
    }

    /// Rows of the segments that were dirty, each once.
    const std::vector<std::int64_t>& cleaned() const { return cleaned_; }

    /// Writes the buffered rows; call it before the commit.
    void flush() {
        insert_.flush();
        note_.flush();
    }

    /// Audit row of the recorded changes, if any.
    const std::optional<std::int64_t>& audit() const { return audit_; }

private:
    ChunkFusion& states() { return states_ ? *states_ : states_.emplace(*database_); }

    void write(std::int64_t chunk, std::int64_t last, const FusedChunk& fused) {
        if (fused.alignment.drives == 0) {
            remove_chunk_.run(chunk);
        } else {
            write_summary(chunk, fused.alignment);
        }
        auto before = numbers_before(chunk, last);
        for (const auto& [fid, state] : fused.segments) {
            write_state(insert_, fid, state, *classes_);
            const Number now{state.iri_um, state.sd_um, state.passes};
            if (const auto old = before.find(fid); old == before.end() || old->second != now) {
                note(fid, now);
            }
            before.erase(fid);
        }
        for (const auto& [fid, number] : before) { // no pass of them is left
            remove_.run(fid);
            note(fid, std::nullopt);
        }
    }

    /// Row of its last segment.
    std::int64_t last_of(std::int64_t chunk) {
        last_.bind(chunk, segments_in_chunk_).step();
        const auto last = last_.integer(0);
        last_.reset();
        return last;
    }

    Numbers numbers_before(std::int64_t chunk, std::int64_t last) {
        Numbers numbers;
        for (select_.bind(chunk, last); select_.step();) {
            numbers[select_.integer(0)] = {
                um_of(select_.real(1)), um_of(select_.real(2)), select_.integer(3)};
        }
        select_.reset();
        return numbers;
    }

    void note(std::int64_t fid, const std::optional<Number>& now) {
        if (!audit_) {
            audit_ = add_audit(*database_, "import", "new passes");
        }
        const auto known = [&](IriUm Number::*value) {
            return now ? std::optional<std::int64_t>{(*now).*value} : std::nullopt;
        };
        note_.add(
            fid, *audit_, known(&Number::iri_um), known(&Number::sd_um), now ? now->passes : 0);
    }

    void write_summary(std::int64_t chunk, const AlignmentSummary& summary) {
        insert_chunk_.run(chunk,
                          summary.drives,
                          summary.found,
                          summary.beyond_reach,
                          summary.moved_far,
                          std::int64_t{summary.middle_lag_cm});
    }

    Database* database_;
    std::optional<ChunkFusion> states_; ///< created on demand
    Statement last_;
    Statement clean_;
    Statement clean_chunk_;
    Statement select_;
    BulkInsert insert_;
    Statement remove_;
    BulkInsert note_;
    Statement insert_chunk_;
    Statement remove_chunk_;
    std::int64_t segments_in_chunk_;
    const ClassTable* classes_;
    std::optional<std::int64_t> audit_;
    std::vector<std::int64_t> cleaned_;
};

/// Chunk to be fused, with the number of attempts so far.
struct WaitingChunk {
    std::int64_t chunk;
    int tries = 0;
};

/// Chunks fused from one snapshot: the first of the waiting chunks.
struct FusedAhead {
    StoreVersion moment;
    std::vector<std::optional<FusedChunk>> chunks; ///< `std::nullopt`: another importer was faster
};

FusedAhead fused_ahead(Database& database,
                       const std::deque<WaitingChunk>& waiting,
                       std::int64_t segments_per_chunk,
                       const Progress& progress) {
    const auto turn_ends = Clock::now() + longest_turn;
    Transaction moment{database, Transaction::Kind::read};
    FusedAhead ahead{moment_of(database), {}};
    ChunkFusion states{database};
    auto is_dirty = database.prepare(
        "SELECT EXISTS (SELECT 1 FROM strip_dirty WHERE strip = ?1) OR EXISTS (SELECT 1"
        " FROM segment_dirty CROSS JOIN main.segment ON fid = segment_dirty.segment"
        " WHERE segment_dirty.segment >= ?1 AND segment_dirty.segment < ?1 + ?2 AND strip = ?1)");
    do {
        const auto chunk = waiting[ahead.chunks.size()].chunk;
        is_dirty.bind(chunk, segments_per_chunk).step();
        ahead.chunks.push_back(is_dirty.integer(0) != 0
                                   ? std::optional{states.of(chunk, segments_per_chunk)}
                                   : std::nullopt);
        is_dirty.reset();
    } while (ahead.chunks.size() < waiting.size() && Clock::now() < turn_ends &&
             !progress.stop.stop_requested());
    return ahead;
}

/// Detects chunks that changed since a version.
class Changes {
public:
    Changes(Database& database, const StoreVersion& before)
        : all_{moment_of(database).maintenance != before.maintenance},
          chunks_{all_ ? std::vector<std::int64_t>{} : chunks_driven_since(database, before)} {}

    bool hold(std::int64_t chunk) const {
        return all_ || std::ranges::binary_search(chunks_, chunk);
    }

private:
    bool all_;
    std::vector<std::int64_t> chunks_;
};

std::deque<WaitingChunk> waiting_chunks(Database& database) {
    std::deque<WaitingChunk> waiting;
    for (const auto chunk : dirty_chunks(database)) {
        waiting.push_back({chunk});
    }
    return waiting;
}

} // namespace

std::size_t fuse_dirty(Database& database,
                       std::int64_t segments_per_chunk,
                       const ClassTable& classes,
                       const Progress& progress,
                       FusionRecord& record) {
    const ForeignKeysOff rows_are_those_read{database};
    auto waiting = waiting_chunks(database);
    const auto whole = waiting.size();
    std::vector<std::int64_t> cleaned;
    for (bool is_first = true; !waiting.empty() && !progress.stop.stop_requested();
         is_first = false) {
        const auto ahead = fused_ahead(database, waiting, segments_per_chunk, progress);
        Transaction turn{database, Transaction::Kind::write};
        const Changes changes{database, ahead.moment};
        if (is_first && record.audit && !renew_audit(database, *record.audit)) {
            record.audit.reset();
        }
        DirtyChunkFusion fusion{database, segments_per_chunk, classes, record.audit};
        for (const auto& fused : ahead.chunks) {
            auto [chunk, tries] = waiting.front();
            waiting.pop_front();
            if (!changes.hold(chunk)) {
                if (fused) {
                    fusion.clean_chunk(chunk, fused);
                }
            } else if (++tries < max_tries) {
                waiting.push_back({chunk, tries});
            } else {
                fusion.clean_chunk(chunk, std::nullopt);
            }
        }
        fusion.flush();
        record.audit = fusion.audit();
        std::ranges::copy(fusion.cleaned(), std::back_inserter(cleaned));
        turn.commit();
        progress(whole - std::min(whole, waiting.size()), whole);
        if (!waiting.empty()) {
            std::this_thread::sleep_for(pause_between_turns);
        }
    }
    std::ranges::sort(cleaned);
    std::vector<std::int64_t> all;
    std::ranges::set_union(record.segments, cleaned, std::back_inserter(all));
    record.segments = std::move(all);
    return cleaned.size();
}

std::size_t
fuse_dirty_at_once(Database& database, const FusionWork& work, const Progress& progress) {
    const auto chunks = dirty_chunks(database);
    DirtyChunkFusion fusion{database, work.segments_per_chunk, *work.classes, work.audit};
    for (std::size_t done = 0; done < chunks.size();) {
        if (progress.stop.stop_requested()) {
            throw InputError{fmt::format("{}: interrupted; the database is unchanged",
                                         database.file().string())};
        }
        const auto chunk = chunks[done++];
        fusion.clean_chunk(chunk, work.staged != nullptr ? work.staged->find(chunk) : std::nullopt);
        progress(done, chunks.size());
    }
    fusion.flush();
    return fusion.cleaned().size();
}

} // namespace macadam
