#include "storage/strip_fusion.hpp"

#include "mapping/strip_cut.hpp"
#include "storage/segment_row.hpp"
#include "storage/strip_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <string>
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
    StripFusion(Database& database, const ClassTable& classes, const FusionConfig& config)
        : traces_{database}, select_{database.prepare(passes_of_strip())}, insert_{database.prepare(
                                                                               insert_state)},
          insert_strip_{
              database.prepare("INSERT OR REPLACE INTO strip_state VALUES (?, ?, ?, ?, ?, ?)")},
          classes_{&classes}, config_{config} {}

    void fuse_strip(std::int64_t strip, std::int64_t segments) {
        const auto traces = traces_.placed(strip);
        write_summary(strip, traces);
        select_.bind(strip, segments);
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

private:
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

    StripTraces traces_;
    Statement select_;
    Statement insert_;
    Statement insert_strip_;
    const ClassTable* classes_;
    FusionConfig config_;
};

} // namespace

std::size_t fuse_dirty(Database& database,
                       std::int64_t segments_in_strip,
                       const ClassTable& classes,
                       const FusionConfig& config,
                       const Progress& progress) {
    constexpr std::size_t report_every = 100;
    const auto strips = dirty_strips(database);
    StripFusion fusion{database, classes, config};
    std::int64_t last = 0;
    std::size_t done = 0;
    for (; done < strips.size() && !progress.stop.stop_requested(); ++done) {
        last = strips[done];
        fusion.fuse_strip(last, segments_in_strip);
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
