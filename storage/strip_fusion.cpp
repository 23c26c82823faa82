#include "storage/strip_fusion.hpp"

#include "storage/segment_row.hpp"
#include "storage/strip_states.hpp"

#include <chrono>
#include <thread>
#include <vector>

namespace macadam {
namespace {

using Clock = std::chrono::steady_clock;

// A waiting importer asks for its turn every 5 ms (sqlite.cpp) and gives up after 20 s.
constexpr std::chrono::milliseconds longest_turn{200};
constexpr std::chrono::milliseconds pause_between_turns{10};

std::vector<std::int64_t> dirty_strips(Database& database) {
    auto select = database.prepare("SELECT DISTINCT segment.strip FROM segment_dirty AS dirty"
                                   " CROSS JOIN segment ON segment.fid = dirty.segment ORDER BY 1");
    std::vector<std::int64_t> strips;
    while (select.step()) {
        strips.push_back(select.integer(0));
    }
    return strips;
}

constexpr const char* clean_segments =
    "DELETE FROM segment_dirty WHERE segment >= ?1 AND segment < ?1 + ?2"
    " AND (SELECT strip FROM segment WHERE fid = segment_dirty.segment) = ?1";

class StripFusion {
public:
    StripFusion(Database& database,
                std::int64_t segments_in_strip,
                const ClassTable& classes,
                const FusionConfig& config)
        : database_{&database}, states_{database, config}, clean_{database.prepare(clean_segments)},
          insert_{database.prepare(insert_state)},
          insert_strip_{
              database.prepare("INSERT OR REPLACE INTO strip_state VALUES (?, ?, ?, ?, ?, ?)")},
          segments_in_strip_{segments_in_strip}, classes_{&classes} {}

    /// \returns how many of its segments were dirty; none if another importer was quicker.
    std::size_t clean_strip(std::int64_t strip) {
        clean_.run(strip, segments_in_strip_);
        const auto cleaned = database_->number("SELECT changes()");
        if (cleaned > 0) {
            write(strip, states_.of(strip, segments_in_strip_));
        }
        return static_cast<std::size_t>(cleaned);
    }

private:
    void write(std::int64_t strip, const FusedStrip& fused) {
        if (!fused.lags.empty()) {
            write_summary(strip, summary_of(fused.lags));
        }
        for (const auto& [fid, state] : fused.segments) {
            write_state(insert_, fid, state, *classes_);
        }
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
    Statement insert_;
    Statement insert_strip_;
    std::int64_t segments_in_strip_;
    const ClassTable* classes_;
};

} // namespace

std::size_t fuse_dirty(Database& database,
                       std::int64_t segments_in_strip,
                       const ClassTable& classes,
                       const FusionConfig& config,
                       const Progress& progress) {
    const auto strips = dirty_strips(database);
    StripFusion fusion{database, segments_in_strip, classes, config};
    std::size_t cleaned = 0;
    std::size_t done = 0;
    while (done < strips.size() && !progress.stop.stop_requested()) {
        const auto turn_ends = Clock::now() + longest_turn;
        Transaction turn{database, Transaction::Kind::write};
        do {
            cleaned += fusion.clean_strip(strips[done++]);
        } while (done < strips.size() && Clock::now() < turn_ends &&
                 !progress.stop.stop_requested());
        turn.commit();
        progress(done, strips.size());
        if (done < strips.size()) {
            std::this_thread::sleep_for(pause_between_turns);
        }
    }
    return cleaned;
}

} // namespace macadam
