#include "storage/strip_fusion.hpp"

#include "estimator/common/error.hpp"
#include "storage/audit.hpp"
#include "storage/segment_row.hpp"
#include "storage/strip_states.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <map>
#include <optional>
#include <thread>
#include <vector>

namespace macadam {
namespace {

using Clock = std::chrono::steady_clock;

// A waiting importer asks for its turn every 5 ms (sqlite.cpp) and gives up after 20 s.
constexpr std::chrono::milliseconds longest_turn{200};
constexpr std::chrono::milliseconds pause_between_turns{10};

std::vector<std::int64_t> dirty_strips(Database& database) {
    auto select = database.prepare(
        "SELECT segment.strip FROM segment_dirty AS dirty"
        " CROSS JOIN segment ON segment.fid = dirty.segment UNION SELECT strip FROM strip_dirty"
        " ORDER BY 1");
    std::vector<std::int64_t> strips;
    while (select.step()) {
        strips.push_back(select.integer(0));
    }
    return strips;
}

constexpr const char* clean_segments =
    "DELETE FROM segment_dirty WHERE segment >= ?1 AND segment < ?1 + ?2"
    " AND (SELECT strip FROM segment WHERE fid = segment_dirty.segment) = ?1";

constexpr const char* states_of_strip =
    "SELECT state.fid, state.iri, state.iri_sd, state.passes FROM segment_state AS state"
    " CROSS JOIN segment ON segment.fid = state.fid"
    " WHERE state.fid >= ?1 AND state.fid < ?1 + ?2 AND segment.strip = ?1";

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
        : database_{&database}, states_{database}, clean_{database.prepare(clean_segments)},
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

    /// \returns how many of its segments were dirty; none if another importer was quicker.
    std::size_t clean_strip(std::int64_t strip) {
        clean_.run(strip, segments_in_strip_);
        const auto cleaned = database_->changes();
        clean_strip_.run(strip);
        if (cleaned > 0 || database_->changes() > 0) {
            write(strip, states_.of(strip, segments_in_strip_));
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
    void write(std::int64_t strip, const FusedStrip& fused) {
        if (fused.lags.empty()) {
            remove_strip_.run(strip);
        } else {
            write_summary(strip, summary_of(fused.lags));
        }
        auto before = numbers_before(strip);
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

    Numbers numbers_before(std::int64_t strip) {
        Numbers numbers;
        for (select_.bind(strip, segments_in_strip_); select_.step();) {
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
    StripStates states_;
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

} // namespace

std::size_t fuse_dirty(Database& database,
                       std::int64_t segments_in_strip,
                       const ClassTable& classes,
                       const Progress& progress) {
    const UncheckedKeys rows_are_those_read{database};
    const auto strips = dirty_strips(database);
    std::optional<std::int64_t> audit;
    std::size_t cleaned = 0;
    std::size_t done = 0;
    while (done < strips.size() && !progress.stop.stop_requested()) {
        const auto turn_ends = Clock::now() + longest_turn;
        Transaction turn{database, Transaction::Kind::write};
        StripFusion fusion{database, segments_in_strip, classes, audit};
        do {
            cleaned += fusion.clean_strip(strips[done++]);
        } while (done < strips.size() && Clock::now() < turn_ends &&
                 !progress.stop.stop_requested());
        fusion.flush();
        audit = fusion.audit();
        turn.commit();
        progress(done, strips.size());
        if (done < strips.size()) {
            std::this_thread::sleep_for(pause_between_turns);
        }
    }
    return cleaned;
}

std::size_t fuse_dirty_at_once(Database& database,
                               std::int64_t segments_in_strip,
                               const ClassTable& classes,
                               std::int64_t audit,
                               const Progress& progress) {
    const auto strips = dirty_strips(database);
    StripFusion fusion{database, segments_in_strip, classes, audit};
    std::size_t cleaned = 0;
    for (std::size_t done = 0; done < strips.size();) {
        if (progress.stop.stop_requested()) {
            throw InputError{
                fmt::format("{}: interrupted; the store is as it was", database.file().string())};
        }
        cleaned += fusion.clean_strip(strips[done++]);
        progress(done, strips.size());
    }
    fusion.flush();
    return cleaned;
}

} // namespace macadam
