#include "mapping/transfer/transferred_intervals.hpp"

#include <algorithm>
#include <tuple>

namespace macadam {
namespace {

constexpr double longest_gap_m = 20; // as for a drive
constexpr double step_back_m = 5;    // maximum overlap of two old roads on a new one
// Allowance beyond the driving time at the speed of the passes: a stop at a crossing.
constexpr double longest_stop_s = 120;
constexpr double min_speed_mps = 0.5;
constexpr double ms_per_s = 1000;
constexpr double mm_per_m = 1000;

double middle_m(const WayMeasureRange& range) {
    return (range.from_m + range.to_m) / 2;
}

double speed_mps(const Pass& pass) {
    return std::max(min_speed_mps, pass.speed_mmps / mm_per_m);
}

/// A reference survey has neither speeds nor times: only stations determine the order.
bool is_driven(const Pass& pass) {
    return pass.speed_mmps > 0;
}

auto key_of(const ChunkKey& chunk) {
    return std::tuple{chunk.way_id, !chunk.forward, chunk.number};
}

bool goes_on(const TransferredInterval& a, const TransferredInterval& b) {
    const double gap_m = b.correspondence.after_m.from_m - a.correspondence.after_m.to_m;
    if (gap_m < -step_back_m) {
        return false;
    }
    if (a.old_chunk == b.old_chunk && a.pass->drive && b.pass->drive) {
        return a.pass->drive == b.pass->drive;
    }
    const double way_m = middle_m(b.correspondence.after_m) - middle_m(a.correspondence.after_m);
    const double slowest_mps = std::min(speed_mps(*a.pass), speed_mps(*b.pass));
    return a.pass->drive.has_value() == b.pass->drive.has_value() && gap_m <= longest_gap_m &&
           (b.t_ms - a.t_ms) / ms_per_s <= way_m / slowest_mps + longest_stop_s;
}

} // namespace

std::vector<ChunkIntervals> intervals_by_chunk(const std::vector<Pass>& passes,
                                               const SegmentCorrespondences& correspondences) {
    const double segment_length_m = correspondences.before().segment_length_m;
    std::map<std::tuple<std::int64_t, bool, std::uint32_t>, ChunkIntervals> by_chunk;
    for (const auto& pass : passes) {
        const auto whole = stations_of(correspondences.before(), pass.segment);
        for (const auto& correspondence : correspondences.of(pass.segment)) {
            const double share = std::min(1.0, pass.covered_mm / mm_per_m / length_m(*whole));
            const double late_m = middle_m(correspondence.before_m) - middle_m(*whole);
            const double late_s = is_driven(pass) ? late_m / speed_mps(pass) : 0;
            by_chunk[key_of(chunk_of(correspondence.after, segment_length_m))].push_back(
                {&pass,
                 chunk_of(pass.segment, segment_length_m),
                 correspondence,
                 share * length_m(correspondence.after_m),
                 static_cast<double>(pass.t_ms) + ms_per_s * late_s});
        }
    }
    std::vector<ChunkIntervals> chunks;
    for (auto& [key, intervals] : by_chunk) {
        std::ranges::stable_sort(intervals, {}, [](const TransferredInterval& interval) {
            return std::tuple{
                interval.t_ms, interval.pass->occurrence, interval.correspondence.after_m.from_m};
        });
        chunks.push_back(std::move(intervals));
    }
    return chunks;
}

std::vector<TransferredDrive> drives_of(const ChunkIntervals& intervals) {
    std::vector<TransferredDrive> drives;
    std::uint32_t next = 0;
    for (const auto& interval : intervals) {
        if (drives.empty() || !goes_on(drives.back().intervals.back(), interval)) {
            drives.push_back({interval.pass->drive ? std::optional{next++} : std::nullopt, {}});
        }
        drives.back().intervals.push_back(interval);
    }
    return drives;
}

} // namespace macadam
