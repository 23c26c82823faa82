#include "storage/strip_fusion.hpp"

#include "estimator/common/error.hpp"
#include "storage/audit.hpp"
#include "storage/segment_row.hpp"
#include "storage/staged_strips.hpp"
#include "storage/store_moment.hpp"
#include "storage/strip_states.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace macadam {
namespace {

using Clock = std::chrono::steady_clock;

// A waiting importer asks for its turn every 5 ms (lock_wait.cpp).
constexpr std::chrono::milliseconds longest_turn{200};
constexpr std::chrono::milliseconds pause_between_turns{10};

constexpr int most_tries = 3; // the last of them under the lock

// The rows of a strip's segments stand one after the other.
constexpr const char* last_of_strip =
    "SELECT fid FROM segment WHERE fid >= ?1 AND fid < ?1 + ?2 AND strip = ?1"
    " ORDER BY fid DESC LIMIT 1";

constexpr const char* clean_segments = "DELETE FROM segment_dirty WHERE segment BETWEEN ? AND ?";

constexpr const char* states_of_strip =
    "SELECT fid, iri, iri_sd, passes FROM segment_state WHERE fid BETWEEN ? AND ?";

/// What is noted when a state changes.
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

/// For one transaction: others may change the rules between two.
class StripFusion {
public:
    StripFusion(Database& database,
                std::int64_t segments_in_strip,
                const ClassTable& classes,
                std::optional<std::int64_t> audit)
        : database_{&database}, last_{database.prepare(last_of_strip)}, clean_{database.prepare(
                                                                            clean_segments)},
          clean_strip_{database.prepare("DELETE FROM strip_dirty WHERE strip = ?")},
          select_{database.prepare(states_of_strip)}, insert_{database,
                                                              insert_state,
                                                              state_column_count},
          remove_{database.prepare("DELETE FROM segment_state WHERE fid = ?")},
          note_{database, "INSERT OR REPLACE INTO state_change", 5},
          insert_strip_{
              database.prepare("INSERT OR REPLACE INTO strip_state VALUES (?, ?, ?, ?, ?, ?)")},
          remove_strip_{database.prepare("DELETE FROM strip_state WHERE strip = ?")},
          segments_in_strip_{segments_in_strip}, classes_{&classes}, audit_{audit} {}

    /// \param fused  what it comes to, where that is known.
    /// \returns how many of its segments were dirty; none if another importer was quicker.
    std::size_t clean_strip(std::int64_t strip, const std::optional<FusedStrip>& fused) {
        const auto last = last_of(strip);
        clean_.run(strip, last);
        const auto cleaned = database_->changes();
        clean_strip_.run(strip);
        if (cleaned > 0 || database_->changes() > 0) {
            if (fused) {
                write(strip, last, *fused);
            } else {
                write(strip, last, states().of(strip, segments_in_strip_));
            }
        }
        return static_cast<std::size_t>(cleaned);
    }

    /// To be called before the commit: rows wait to be written together.
    void flush() {
        insert_.flush();
        note_.flush();
    }

    /// The row under which changes were noted, if there were any.
    const std::optional<std::int64_t>& audit() const { return audit_; }

private:
    StripStates& states() { return states_ ? *states_ : states_.emplace(*database_); }

    void write(std::int64_t strip, std::int64_t last, const FusedStrip& fused) {
        if (fused.laid.drives == 0) {
            remove_strip_.run(strip);
        } else {
            write_summary(strip, fused.laid);
        }
        auto before = numbers_before(strip, last);
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
    std::int64_t last_of(std::int64_t strip) {
        last_.bind(strip, segments_in_strip_).step();
        const auto last = last_.integer(0);
        last_.reset();
        return last;
    }

    Numbers numbers_before(std::int64_t strip, std::int64_t last) {
        Numbers numbers;
        for (select_.bind(strip, last); select_.step();) {
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

    void write_summary(std::int64_t strip, const LaySummary& summary) {
        insert_strip_.run(strip,
                          summary.drives,
                          summary.found,
                          summary.beyond_reach,
                          summary.moved_far,
                          std::int64_t{summary.middle_lag_cm});
    }

    Database* database_;
    std::optional<StripStates> states_; ///< made when it is needed
    Statement last_;
    Statement clean_;
    Statement clean_strip_;
    Statement select_;
    BulkInsert insert_;
    Statement remove_;
    BulkInsert note_;
    Statement insert_strip_;
    Statement remove_strip_;
    std::int64_t segments_in_strip_;
    const ClassTable* classes_;
    std::optional<std::int64_t> audit_;
};

/// A strip that waits to be fused, and how often that was tried.
struct WaitingStrip {
    std::int64_t strip;
    int tries = 0;
};

/// Strips that were fused at one moment, the first of those that wait.
struct FusedAhead {
    StoreMoment moment;
    std::vector<std::optional<FusedStrip>> strips; ///< nothing: another importer was quicker
};

FusedAhead fused_ahead(Database& database,
                       const std::deque<WaitingStrip>& waiting,
                       std::int64_t segments_in_strip,
                       const Progress& progress) {
    const auto turn_ends = Clock::now() + longest_turn;
    Transaction moment{database, Transaction::Kind::read};
    FusedAhead ahead{moment_of(database), {}};
    StripStates states{database};
    auto is_dirty = database.prepare(
        "SELECT EXISTS (SELECT 1 FROM strip_dirty WHERE strip = ?1) OR EXISTS (SELECT 1"
        " FROM segment_dirty CROSS JOIN main.segment ON fid = segment_dirty.segment"
        " WHERE segment_dirty.segment >= ?1 AND segment_dirty.segment < ?1 + ?2 AND strip = ?1)");
    do {
        const auto strip = waiting[ahead.strips.size()].strip;
        is_dirty.bind(strip, segments_in_strip).step();
        ahead.strips.push_back(is_dirty.integer(0) != 0
                                   ? std::optional{states.of(strip, segments_in_strip)}
                                   : std::nullopt);
        is_dirty.reset();
    } while (ahead.strips.size() < waiting.size() && Clock::now() < turn_ends &&
             !progress.stop.stop_requested());
    return ahead;
}

/// Which strips are not what they were.
class Changes {
public:
    Changes(Database& database, const StoreMoment& before)
        : all_{moment_of(database).upkeep != before.upkeep},
          strips_{all_ ? std::vector<std::int64_t>{} : strips_driven_since(database, before)} {}

    bool hold(std::int64_t strip) const {
        return all_ || std::ranges::binary_search(strips_, strip);
    }

private:
    bool all_;
    std::vector<std::int64_t> strips_;
};

std::deque<WaitingStrip> waiting_strips(Database& database) {
    std::deque<WaitingStrip> waiting;
    for (const auto strip : dirty_strips(database)) {
        waiting.push_back({strip});
    }
    return waiting;
}

} // namespace

std::size_t fuse_dirty(Database& database,
                       std::int64_t segments_in_strip,
                       const ClassTable& classes,
                       const Progress& progress) {
    const UncheckedKeys rows_are_those_read{database};
    auto waiting = waiting_strips(database);
    const auto whole = waiting.size();
    std::optional<std::int64_t> audit;
    std::size_t cleaned = 0;
    while (!waiting.empty() && !progress.stop.stop_requested()) {
        const auto ahead = fused_ahead(database, waiting, segments_in_strip, progress);
        Transaction turn{database, Transaction::Kind::write};
        const Changes changes{database, ahead.moment};
        StripFusion fusion{database, segments_in_strip, classes, audit};
        for (const auto& fused : ahead.strips) {
            auto [strip, tries] = waiting.front();
            waiting.pop_front();
            if (!changes.hold(strip)) {
                cleaned += fused ? fusion.clean_strip(strip, fused) : 0;
            } else if (++tries < most_tries) {
                waiting.push_back({strip, tries});
            } else {
                cleaned += fusion.clean_strip(strip, std::nullopt);
            }
        }
        fusion.flush();
        audit = fusion.audit();
        turn.commit();
        progress(whole - std::min(whole, waiting.size()), whole);
        if (!waiting.empty()) {
            std::this_thread::sleep_for(pause_between_turns);
        }
    }
    return cleaned;
}

std::size_t
fuse_dirty_at_once(Database& database, const FusionWork& work, const Progress& progress) {
    const auto strips = dirty_strips(database);
    StripFusion fusion{database, work.segments_in_strip, *work.classes, work.audit};
    std::size_t cleaned = 0;
    for (std::size_t done = 0; done < strips.size();) {
        if (progress.stop.stop_requested()) {
            throw InputError{
                fmt::format("{}: interrupted; the store is as it was", database.file().string())};
        }
        const auto strip = strips[done++];
        cleaned += fusion.clean_strip(
            strip, work.staged != nullptr ? work.staged->find(strip) : std::nullopt);
        progress(done, strips.size());
    }
    fusion.flush();
    return cleaned;
}

} // namespace macadam
