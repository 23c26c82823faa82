#include "storage/strip_fusion.hpp"

#include "mapping/strip_cut.hpp"
#include "storage/segment_row.hpp"
#include "storage/strip_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <span>
#include <string>
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

/// Rows of a strip's segments stand one after the other.
const std::string& passes_of_strip() {
    static const std::string sql = fmt::format(
        "SELECT pass.segment, segment.way_id, segment.direction, segment.seq, trip.sha256,"
        " trip.vehicle, trip.t0_utc_ms, segment.from_m, segment.to_m, {}"
        " FROM segment CROSS JOIN pass ON pass.segment = segment.fid"
        " CROSS JOIN trip ON trip.id = pass.trip"
        " WHERE segment.fid >= ?1 AND segment.fid < ?1 + ?2 AND segment.strip = ?1"
        " ORDER BY segment.fid, trip.sha256, pass.occurrence",
        pass_columns);
    return sql;
}

/// The pass where its trace lies among the others.
Pass in_its_place(const Pass& pass,
                  const Statement& row,
                  const std::string& trip_sha256,
                  std::span<const PlacedTrace> traces) {
    const auto* placed = find_trace(traces, trip_sha256, pass.drive);
    if (placed == nullptr) {
        return pass;
    }
    const bool forward = pass.segment.forward;
    const double from_m = station_m(forward, row.real(forward ? 7 : 8));
    const double to_m = station_m(forward, row.real(forward ? 8 : 7));
    return moved(
        pass, from_m, to_m, placed->trace, lag_m(placed->lag, from_m), lag_m(placed->lag, to_m));
}

FusionInput input_in(const Statement& row, std::span<const PlacedTrace> traces) {
    const SegmentKey key{
        row.integer(1), row.text(2) == "forward", static_cast<std::uint32_t>(row.integer(3))};
    FusionInput input{pass_in(row, 9, key), row.text(4), row.integer(5), known_utc_ms(row, 6)};
    input.utc_ms = utc_ms_of(input.utc_ms, input.pass);
    input.pass = in_its_place(input.pass, row, input.trip_sha256, traces);
    return input;
}

class StripFusion {
public:
    StripFusion(Database& database,
                std::int64_t segments_in_strip,
                const ClassTable& classes,
                const FusionConfig& config)
        : database_{&database}, traces_{database}, clean_{database.prepare(clean_segments)},
          select_{database.prepare(passes_of_strip())}, insert_{database.prepare(insert_state)},
          insert_strip_{
              database.prepare("INSERT OR REPLACE INTO strip_state VALUES (?, ?, ?, ?, ?, ?)")},
          segments_in_strip_{segments_in_strip}, classes_{&classes}, config_{config} {}

    /// \returns how many of its segments were dirty; none if another importer was quicker.
    std::size_t clean_strip(std::int64_t strip) {
        clean_.run(strip, segments_in_strip_);
        const auto cleaned = database_->number("SELECT changes()");
        if (cleaned > 0) {
            fuse_strip(strip);
        }
        return static_cast<std::size_t>(cleaned);
    }

private:
    void fuse_strip(std::int64_t strip) {
        const auto traces = traces_.placed(strip);
        write_summary(strip, traces);
        select_.bind(strip, segments_in_strip_);
        for (bool more = select_.step(); more;) {
            const auto segment = select_.integer(0);
            std::vector<FusionInput> inputs;
            do {
                inputs.push_back(input_in(select_, traces));
                more = select_.step();
            } while (more && select_.integer(0) == segment);
            write_state(insert_, segment, fuse(inputs, config_), *classes_);
        }
        select_.reset();
    }

    void write_summary(std::int64_t strip, std::span<const PlacedTrace> traces) {
        if (traces.empty()) {
            return;
        }
        std::vector<LagLine> lines;
        std::ranges::transform(traces, std::back_inserter(lines), &PlacedTrace::lag);
        const auto summary = summary_of(lines);
        insert_strip_.run(strip,
                          summary.drives,
                          summary.found,
                          summary.beyond_reach,
                          summary.moved_far,
                          std::int64_t{summary.middle_lag_cm});
    }

    Database* database_;
    StripTraces traces_;
    Statement clean_;
    Statement select_;
    Statement insert_;
    Statement insert_strip_;
    std::int64_t segments_in_strip_;
    const ClassTable* classes_;
    FusionConfig config_;
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
