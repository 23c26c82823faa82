#include "mapping/change/carried_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace macadam {
namespace {

constexpr double longest_gap_m = 20; // as of a drive
constexpr double step_back_m = 5;    // two old roads may claim so much of a new one
// Beyond what the road takes at the speed of the passes: a stop at a crossing.
constexpr double longest_stop_s = 120;
constexpr double least_speed_mps = 0.5;
constexpr double ms_per_s = 1000;
constexpr double mm_per_m = 1000;

double middle_m(const StationRange& range) {
    return (range.from_m + range.to_m) / 2;
}

double speed_mps(const Pass& pass) {
    return std::max(least_speed_mps, pass.speed_mmps / mm_per_m);
}

/// A reference survey has neither speeds nor times: its stations alone tell the order.
bool is_driven(const Pass& pass) {
    return pass.speed_mmps > 0;
}

auto key_of(const StripKey& strip) {
    return std::tuple{strip.way_id, !strip.forward, strip.number};
}

bool goes_on(const CarriedPiece& a, const CarriedPiece& b) {
    const double gap_m = b.heir.after_m.from_m - a.heir.after_m.to_m;
    if (gap_m < -step_back_m) {
        return false;
    }
    if (a.old_strip == b.old_strip && a.pass->drive && b.pass->drive) {
        return a.pass->drive == b.pass->drive;
    }
    const double way_m = middle_m(b.heir.after_m) - middle_m(a.heir.after_m);
    const double slowest_mps = std::min(speed_mps(*a.pass), speed_mps(*b.pass));
    return a.pass->drive.has_value() == b.pass->drive.has_value() && gap_m <= longest_gap_m &&
           (b.t_ms - a.t_ms) / ms_per_s <= way_m / slowest_mps + longest_stop_s;
}

} // namespace

std::vector<StripPieces> pieces_by_strip(const std::vector<Pass>& passes,
                                         const SegmentHeirs& heirs) {
    const double segment_length_m = heirs.before().segment_length_m;
    std::map<std::tuple<std::int64_t, bool, std::uint32_t>, StripPieces> by_strip;
    for (const auto& pass : passes) {
        const auto whole = stations_of(heirs.before(), pass.segment);
        for (const auto& heir : heirs.of(pass.segment)) {
            const double share = std::min(1.0, pass.covered_mm / mm_per_m / length_m(*whole));
            const double late_m = middle_m(heir.before_m) - middle_m(*whole);
            const double late_s = is_driven(pass) ? late_m / speed_mps(pass) : 0;
            by_strip[key_of(strip_of(heir.after, segment_length_m))].push_back(
                {&pass,
                 strip_of(pass.segment, segment_length_m),
                 heir,
                 share * length_m(heir.after_m),
                 static_cast<double>(pass.t_ms) + ms_per_s * late_s});
        }
    }
    std::vector<StripPieces> strips;
    for (auto& [key, pieces] : by_strip) {
        std::ranges::stable_sort(pieces, {}, [](const CarriedPiece& piece) {
            return std::tuple{piece.t_ms, piece.pass->occurrence, piece.heir.after_m.from_m};
        });
        strips.push_back(std::move(pieces));
    }
    return strips;
}

std::vector<CarriedDrive> drives_of(const StripPieces& pieces) {
    std::vector<CarriedDrive> drives;
    std::uint32_t next = 0;
    for (const auto& piece : pieces) {
        if (drives.empty() || !goes_on(drives.back().pieces.back(), piece)) {
            drives.push_back({piece.pass->drive ? std::optional{next++} : std::nullopt, {}});
        }
        drives.back().pieces.push_back(piece);
    }
    return drives;
}

} // namespace macadam
