#include "storage/store/fusion/chunk_trace_rows.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace macadam {
namespace {

std::vector<RoughnessCode> codes_in(std::string_view bytes) {
    return {bytes.begin(), bytes.end()};
}

// Limits far above any real chunk, because any SQLite tool can edit the database.
constexpr std::int64_t max_station_m = 20'000'000;
constexpr std::int64_t longest_chunk_m = 250'000;
constexpr std::int64_t max_sd_mm = 1'000'000;

bool is_sound(const Statement& row) {
    const auto first_m = row.integer(2);
    const auto left = row.blob(5).size();
    const auto size = row.blob(4).size();
    const auto sd_mm = row.integer(3);
    return size > 0 && size <= longest_chunk_m && (left == 0 || left == size) &&
           first_m >= -max_station_m && first_m <= max_station_m && sd_mm > 0 && sd_mm <= max_sd_mm;
}

bool is_within_a_chunk(std::span<const AlignedTrace> traces) {
    auto first_m = max_station_m;
    auto last_m = -max_station_m;
    for (const auto& [trip, trace, lag] : traces) {
        first_m = std::min<std::int64_t>(first_m, trace.first_m);
        last_m = std::max<std::int64_t>(last_m, trace.first_m);
    }
    return last_m - first_m <= longest_chunk_m;
}

std::vector<AlignedTrace> aligned_with_each_other(std::vector<AlignedTrace> traces) {
    std::vector<RoughnessTrace> all;
    std::ranges::transform(traces, std::back_inserter(all), &AlignedTrace::trace);
    auto lags = lags_of(all, {});
    for (std::size_t i = 0; i < traces.size(); ++i) {
        traces[i].lag = std::move(lags[i]);
    }
    return traces;
}

} // namespace

ChunkTraces::ChunkTraces(Database& database)
    : database_{&database}, select_{database.prepare(
                                "SELECT trip.sha256, trace.drive, trace.first_m, trace.place_sd_mm,"
                                " trace.iri, trace.iri_left FROM trace"
                                " CROSS JOIN trip ON trip.id = trace.trip WHERE trace.strip = ?")} {
}

std::vector<AlignedTrace> ChunkTraces::placed(std::int64_t chunk) {
    return aligned_with_each_other(unplaced(chunk));
}

std::vector<AlignedTrace> ChunkTraces::placed(std::int64_t chunk, const DriveSet& drives) {
    auto traces = unplaced(chunk);
    std::erase_if(traces, [&](const AlignedTrace& placed) {
        return !drives.contains({placed.trip_sha256, placed.trace.drive});
    });
    return aligned_with_each_other(std::move(traces));
}

std::vector<AlignedTrace> ChunkTraces::unplaced(std::int64_t chunk) {
    std::vector<AlignedTrace> traces;
    bool sound = true;
    for (select_.bind(chunk); sound && select_.step();) {
        sound = is_sound(select_);
        traces.push_back({.trip_sha256 = select_.text(0),
                          .trace = {.chunk = {},
                                    .drive = static_cast<std::uint32_t>(select_.integer(1)),
                                    .first_m = static_cast<std::int32_t>(select_.integer(2)),
                                    .iri = codes_in(select_.blob(4)),
                                    .left = codes_in(select_.blob(5)),
                                    .place_sd_mm = static_cast<std::int32_t>(select_.integer(3))},
                          .lag = {}});
    }
    select_.reset();
    if (!sound || !is_within_a_chunk(traces)) {
        throw InputError{fmt::format("{}: the trace of strip '{}' is invalid; the database was "
                                     "modified by another program",
                                     database_->file().string(),
                                     chunk)};
    }
    std::ranges::sort(traces, {}, [](const AlignedTrace& placed) {
        return std::pair<std::string_view, std::uint32_t>{placed.trip_sha256, placed.trace.drive};
    });
    return traces;
}

const AlignedTrace* find_trace(std::span<const AlignedTrace> traces,
                               const std::string& trip_sha256,
                               const std::optional<std::uint32_t>& drive) {
    if (!drive) {
        return nullptr;
    }
    const std::pair<std::string_view, std::uint32_t> wanted{trip_sha256, *drive};
    const auto key_of = [](const AlignedTrace& placed) {
        return std::pair<std::string_view, std::uint32_t>{placed.trip_sha256, placed.trace.drive};
    };
    const auto found = std::ranges::lower_bound(traces, wanted, {}, key_of);
    return found != traces.end() && key_of(*found) == wanted ? &*found : nullptr;
}

} // namespace macadam
