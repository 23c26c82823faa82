#include "storage/store/fusion/chunk_states.hpp"

#include "mapping/passes/trip_cutting.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/schema/store_schema.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace macadam {
namespace {

bool is_in(const Period& period, const std::optional<std::int64_t>& utc_ms) {
    return utc_ms && !(period.from_ms && *utc_ms < *period.from_ms) &&
           !(period.until_ms && *utc_ms >= *period.until_ms);
}

bool is_chosen(const PassChoice& choice, const FusionInput& input) {
    return !(choice.cars_alone && input.reference) &&
           (!choice.vehicle || input.vehicle == *choice.vehicle) &&
           (!choice.period || is_in(*choice.period, input.utc_ms));
}

std::optional<std::int64_t> row_of_unknown_car(Database& database) {
    auto select = database.prepare("SELECT id FROM vehicle WHERE pseudonym = ?");
    return select.bind(unknown_car).step() ? std::optional{select.integer(0)} : std::nullopt;
}

/// Sets the lag of a pass from its aligned trace.
void put_in_its_place(ChunkPass& pass, std::span<const AlignedTrace> traces) {
    auto& input = pass.input;
    const auto* placed = find_trace(traces, input.trip_sha256, input.pass.drive);
    if (placed != nullptr) {
        input.pass = moved(input.pass,
                           pass.from_m,
                           pass.to_m,
                           placed->trace,
                           lag_m(placed->lag, pass.from_m),
                           lag_m(placed->lag, pass.to_m));
    }
}

/// Sets the calibration of the car's period to which a pass belongs.
void set_calibration(FusionInput& input, const CarRecord& car) {
    input.calibration = car.calibration;
    if (!car.periods.empty()) {
        const auto period = period_at(car.periods, input.utc_ms);
        input.period = static_cast<std::uint32_t>(period);
        input.calibration =
            period < car.periods.size() ? car.periods[period].calibration : std::nullopt;
    }
}

std::vector<FusedSegment> fused(std::vector<ChunkPass> passes,
                                std::span<const AlignedTrace> traces,
                                const FusionConfig& config) {
    std::vector<FusedSegment> segments;
    std::vector<FusionInput> inputs;
    for (std::size_t i = 0; i < passes.size();) {
        const auto fid = passes[i].fid;
        inputs.clear();
        for (; i < passes.size() && passes[i].fid == fid; ++i) {
            put_in_its_place(passes[i], traces);
            inputs.push_back(std::move(passes[i].input));
        }
        segments.push_back({fid, fuse(inputs, config)});
    }
    return segments;
}

} // namespace

DriveSet drives_of(std::span<const ChunkPass> passes) {
    DriveSet drives;
    for (const auto& [fid, input, from_m, to_m] : passes) {
        if (input.pass.drive) {
            drives.emplace(input.trip_sha256, *input.pass.drive);
        }
    }
    return drives;
}

ChunkFusion::ChunkFusion(Database& database)
    : traces_{database}, passes_{database}, valid_from_{database}, cars_{read_calibrations(
                                                                       database)},
      config_{read_fusion_config(database)}, limit_{read_max_trips_per_car_month(database),
                                                    row_of_unknown_car(database)} {}

std::vector<ChunkPass> ChunkFusion::valid_passes(std::int64_t chunk, std::int64_t segments) {
    auto passes = passes_.of(chunk, segments);
    if (const auto since_ms = valid_from_.of(chunk, chunk + segments); !since_ms.empty()) {
        std::erase_if(passes, [&](const ChunkPass& pass) {
            const auto since = since_ms.find(pass.fid);
            return since != since_ms.end() &&
                   !(pass.input.utc_ms && *pass.input.utc_ms >= since->second);
        });
    }
    keep_limited(passes);
    for (auto& pass : passes) {
        if (const auto car = cars_.find(pass.input.vehicle); car != cars_.end()) {
            set_calibration(pass.input, car->second);
        }
    }
    return passes;
}

/// Removes the passes of trips beyond the limit, so that neither they nor their traces cost
/// anything.
void ChunkFusion::keep_limited(std::vector<ChunkPass>& passes) {
    if (!limit_.is_limited()) {
        return;
    }
    std::optional<std::int64_t> segment;
    std::vector<ChunkPass> kept;
    for (auto& pass : passes) {
        if (segment != pass.fid) {
            limit_.begin_segment();
            segment = pass.fid;
        }
        if (limit_.admits(pass.input)) {
            kept.push_back(std::move(pass));
        }
    }
    passes = std::move(kept);
}

std::vector<ChunkPass> ChunkFusion::readings(std::int64_t chunk,
                                             std::int64_t segments,
                                             const std::unordered_set<std::string>& trips) {
    auto passes = passes_.of(chunk, segments);
    std::erase_if(passes,
                  [&](const auto& pass) { return !trips.contains(pass.input.trip_sha256); });
    align_with_each_other(chunk, passes);
    return passes;
}

std::vector<ChunkPass> ChunkFusion::passes_of_cars(std::int64_t chunk, std::int64_t segments) {
    auto passes = valid_passes(chunk, segments);
    std::erase_if(passes, [](const ChunkPass& pass) { return pass.input.reference; });
    return passes;
}

void ChunkFusion::align_with_each_other(std::int64_t chunk, std::vector<ChunkPass>& passes) {
    const auto traces = traces_.placed(chunk, drives_of(passes));
    for (auto& pass : passes) {
        put_in_its_place(pass, traces);
    }
}

FusedChunk ChunkFusion::of(std::int64_t chunk, std::int64_t segments_per_chunk) {
    auto passes = valid_passes(chunk, segments_per_chunk);
    const auto traces =
        limit_.is_limited() ? traces_.placed(chunk, drives_of(passes)) : traces_.placed(chunk);
    std::vector<LagLine> lags;
    std::ranges::transform(traces, std::back_inserter(lags), &AlignedTrace::lag);
    return {summary_of(lags), fused(std::move(passes), traces, config_)};
}

std::vector<FusedSegment>
ChunkFusion::of(std::int64_t chunk, std::int64_t segments_per_chunk, const PassChoice& choice) {
    auto chosen = passes(chunk, segments_per_chunk, choice);
    if (chosen.empty()) {
        return {};
    }
    const auto traces = traces_.placed(chunk, drives_of(chosen));
    return fused(std::move(chosen), traces, config_);
}

std::vector<ChunkPass>
ChunkFusion::passes(std::int64_t chunk, std::int64_t segments_per_chunk, const PassChoice& choice) {
    auto passes = valid_passes(chunk, segments_per_chunk);
    std::erase_if(passes, [&](const auto& pass) { return !is_chosen(choice, pass.input); });
    return passes;
}

} // namespace macadam
