#include "mapping/transfer/transferred_trace.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

constexpr std::int32_t sd_step_mm = 100; // rounding of cut_trip

/// An interval with the old trace that was read there.
struct TracedInterval {
    WayMeasureRange before_m;
    WayMeasureRange after_m;
    const RoughnessTrace* trace;
};

std::vector<TracedInterval> traced_intervals(const TransferredDrive& drive,
                                             const std::vector<RoughnessTrace>& old) {
    std::vector<TracedInterval> intervals;
    for (const auto& interval : drive.intervals) {
        const auto trace = std::ranges::find_if(old, [&](const RoughnessTrace& each) {
            return each.chunk == interval.old_chunk && each.drive == interval.pass->drive;
        });
        if (trace != old.end()) {
            intervals.push_back(
                {interval.correspondence.before_m, interval.correspondence.after_m, &*trace});
        }
    }
    std::ranges::stable_sort(
        intervals, {}, [](const TracedInterval& interval) { return interval.after_m.from_m; });
    return intervals;
}

double off_m(const WayMeasureRange& range, double station_m) {
    return std::max({0.0, range.from_m - station_m, station_m - range.to_m});
}

/// Maps a station to the old way; one to one beyond the ends of the interval.
double old_station_m(const TracedInterval& interval, double station_m) {
    const double scale = length_m(interval.before_m) / length_m(interval.after_m);
    const double within_m = std::clamp(station_m, interval.after_m.from_m, interval.after_m.to_m);
    return interval.before_m.from_m + scale * (within_m - interval.after_m.from_m) +
           (station_m - within_m);
}

TraceCell cell_at(const TracedInterval& interval, double station_m) {
    const auto i = static_cast<std::int64_t>(std::floor(old_station_m(interval, station_m))) -
                   interval.trace->first_m;
    if (i < 0 || i >= static_cast<std::int64_t>(interval.trace->iri.size())) {
        return {};
    }
    const auto k = static_cast<std::size_t>(i);
    return {interval.trace->iri[k],
            interval.trace->left.empty() ? no_roughness : interval.trace->left[k]};
}

/// Returns the mean weighted by interval length, in whole decimetres.
std::int32_t place_sd_mm(const std::vector<TracedInterval>& intervals) {
    double sum = 0;
    double all_m = 0;
    for (const auto& interval : intervals) {
        sum += length_m(interval.after_m) * interval.trace->place_sd_mm;
        all_m += length_m(interval.after_m);
    }
    return sd_step_mm * static_cast<std::int32_t>(std::lround(sum / all_m / sd_step_mm));
}

} // namespace

std::optional<RoughnessTrace> trace_of(const TransferredDrive& drive,
                                       const std::vector<RoughnessTrace>& old,
                                       double segment_length_m) {
    const auto intervals = traced_intervals(drive, old);
    if (intervals.empty() || !drive.number) {
        return std::nullopt;
    }
    const double last_m = std::ranges::max(intervals, {}, [](const TracedInterval& interval) {
                              return interval.after_m.to_m;
                          }).after_m.to_m;
    const auto first =
        static_cast<std::int32_t>(std::floor(intervals.front().after_m.from_m - trace_margin_m));
    const auto past = static_cast<std::int32_t>(std::ceil(last_m + trace_margin_m));
    std::vector<TraceCell> cells;
    for (auto metre = first; metre < past; ++metre) {
        const double middle_m = metre + 0.5;
        const auto nearest =
            std::ranges::min_element(intervals, {}, [&](const TracedInterval& interval) {
                return off_m(interval.after_m, middle_m);
            });
        cells.push_back(cell_at(*nearest, middle_m));
    }
    auto trace = with_cells(
        {.chunk = chunk_of(drive.intervals.front().correspondence.after, segment_length_m),
         .drive = *drive.number,
         .first_m = first,
         .iri = {},
         .left = {},
         .place_sd_mm = place_sd_mm(intervals)},
        cells);
    return trace.iri.empty() ? std::nullopt : std::optional{std::move(trace)};
}

} // namespace macadam
