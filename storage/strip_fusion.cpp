#include "storage/strip_fusion.hpp"

#include "storage/segment_row.hpp"
#include "storage/strip_states.hpp"

#include <vector>

namespace macadam {
namespace {

std::vector<std::int64_t> dirty_strips(Database& database) {
    auto select = database.prepare("SELECT DISTINCT segment.strip FROM segment_dirty AS dirty"
                                   " CROSS JOIN segment ON segment.fid = dirty.segment ORDER BY 1");
    std::vector<std::int64_t> strips;
    while (select.step()) {
        strips.push_back(select.integer(0));
    }
    return strips;
}

class StripWriter {
public:
    StripWriter(Database& database, const ClassTable& classes)
        : insert_{database.prepare(insert_state)},
          insert_strip_{
              database.prepare("INSERT OR REPLACE INTO strip_state VALUES (?, ?, ?, ?, ?, ?)")},
          classes_{&classes} {}

    void write(std::int64_t strip, const FusedStrip& fused) {
        if (!fused.lags.empty()) {
            write_summary(strip, summary_of(fused.lags));
        }
        for (const auto& [fid, state] : fused.segments) {
            write_state(insert_, fid, state, *classes_);
        }
    }

private:
    void write_summary(std::int64_t strip, const LaySummary& summary) {
        insert_strip_.run(strip,
                          summary.drives,
                          summary.found,
                          summary.beyond_reach,
                          summary.moved_far,
                          std::int64_t{summary.middle_lag_cm});
    }

    Statement insert_;
    Statement insert_strip_;
    const ClassTable* classes_;
};

} // namespace

std::size_t fuse_dirty(Database& database,
                       std::int64_t segments_in_strip,
                       const ClassTable& classes,
                       const FusionConfig& config,
                       const Progress& progress) {
    constexpr std::size_t report_every = 100;
    const auto strips = dirty_strips(database);
    StripStates states{database, config};
    StripWriter writer{database, classes};
    std::int64_t last = 0;
    std::size_t done = 0;
    for (; done < strips.size() && !progress.stop.stop_requested(); ++done) {
        last = strips[done];
        writer.write(last, states.of(last, segments_in_strip));
        if (done % report_every == 0) {
            progress(done, strips.size());
        }
    }
    database
        .prepare("DELETE FROM segment_dirty WHERE coalesce("
                 "(SELECT strip FROM segment WHERE fid = segment_dirty.segment), 0) <= ?")
        .run(last);
    progress(done, strips.size());
    return static_cast<std::size_t>(database.number("SELECT changes()"));
}

} // namespace macadam
