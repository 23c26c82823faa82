#include "storage/strip_states.hpp"

#include "mapping/strip_cut.hpp"
#include "storage/segment_row.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

namespace macadam {
namespace {

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

StripPass pass_of_strip(const Statement& row) {
    const SegmentKey key{
        row.integer(1), row.text(2) == "forward", static_cast<std::uint32_t>(row.integer(3))};
    FusionInput input{pass_in(row, 9, key), row.text(4), row.integer(5), known_utc_ms(row, 6)};
    input.utc_ms = utc_ms_of(input.utc_ms, input.pass);
    return {row.integer(0),
            std::move(input),
            station_m(key.forward, row.real(key.forward ? 7 : 8)),
            station_m(key.forward, row.real(key.forward ? 8 : 7))};
}

bool is_in(const Period& period, const std::optional<std::int64_t>& utc_ms) {
    return utc_ms && !(period.from_ms && *utc_ms < *period.from_ms) &&
           !(period.until_ms && *utc_ms >= *period.until_ms);
}

DriveSet drives_of(const std::vector<StripPass>& passes) {
    DriveSet drives;
    for (const auto& [fid, input, from_m, to_m] : passes) {
        if (input.pass.drive) {
            drives.emplace(input.trip_sha256, *input.pass.drive);
        }
    }
    return drives;
}

/// The pass where its trace lies among the others.
FusionInput in_its_place(const StripPass& pass, std::span<const PlacedTrace> traces) {
    auto input = pass.input;
    const auto* placed = find_trace(traces, input.trip_sha256, input.pass.drive);
    if (placed != nullptr) {
        input.pass = moved(input.pass,
                           pass.from_m,
                           pass.to_m,
                           placed->trace,
                           lag_m(placed->lag, pass.from_m),
                           lag_m(placed->lag, pass.to_m));
    }
    return input;
}

std::vector<FusedSegment> fused(const std::vector<StripPass>& passes,
                                std::span<const PlacedTrace> traces,
                                const FusionConfig& config) {
    std::vector<FusedSegment> segments;
    for (std::size_t i = 0; i < passes.size();) {
        const auto fid = passes[i].fid;
        std::vector<FusionInput> inputs;
        for (; i < passes.size() && passes[i].fid == fid; ++i) {
            inputs.push_back(in_its_place(passes[i], traces));
        }
        segments.push_back({fid, fuse(inputs, config)});
    }
    return segments;
}

} // namespace

StripStates::StripStates(Database& database)
    : traces_{database}, select_{database.prepare(passes_of_strip())}, valid_from_{database},
      cars_{read_calibrations(database)}, config_{read_fusion_config(database)} {}

std::vector<StripPass> StripStates::valid_passes(std::int64_t strip, std::int64_t segments) {
    const auto from_ms = valid_from_.of(strip, strip + segments);
    std::vector<StripPass> passes;
    for (select_.bind(strip, segments); select_.step();) {
        auto pass = pass_of_strip(select_);
        const auto from = from_ms.find(pass.fid);
        if (from != from_ms.end() && !(pass.input.utc_ms && *pass.input.utc_ms >= from->second)) {
            continue;
        }
        if (const auto car = cars_.find(pass.input.vehicle); car != cars_.end()) {
            pass.input.calibration = car->second.calibration;
        }
        passes.push_back(std::move(pass));
    }
    select_.reset();
    return passes;
}

std::vector<StripPass> StripStates::passes(std::int64_t strip, std::int64_t segments) {
    const auto traces = traces_.placed(strip);
    auto passes = valid_passes(strip, segments);
    for (auto& pass : passes) {
        pass.input = in_its_place(pass, traces);
    }
    return passes;
}

FusedStrip StripStates::of(std::int64_t strip, std::int64_t segments_in_strip) {
    const auto traces = traces_.placed(strip);
    FusedStrip all;
    std::ranges::transform(traces, std::back_inserter(all.lags), &PlacedTrace::lag);
    all.segments = fused(valid_passes(strip, segments_in_strip), traces, config_);
    return all;
}

std::vector<FusedSegment>
StripStates::of(std::int64_t strip, std::int64_t segments_in_strip, const Period& period) {
    auto passes = valid_passes(strip, segments_in_strip);
    std::erase_if(passes, [&](const auto& pass) { return !is_in(period, pass.input.utc_ms); });
    if (passes.empty()) {
        return {};
    }
    return fused(passes, traces_.placed(strip, drives_of(passes)), config_);
}

} // namespace macadam
