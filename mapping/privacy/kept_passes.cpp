#include "mapping/privacy/kept_passes.hpp"

#include <algorithm>
#include <utility>

namespace macadam {
namespace {

constexpr std::int64_t longest_pause_ms = 300'000;

/// Counts the first passes within a length of their start, by travel or by straight-line distance.
std::size_t passes_within(std::span<const PassedSegment> passed, double length_m) {
    const auto& hidden = passed.front().from;
    double travel_m = 0;
    for (std::size_t i = 0; i < passed.size(); ++i) {
        const auto& segment = passed[i];
        const double away_m =
            std::min(distance_m(hidden, segment.from), distance_m(hidden, segment.to));
        if (std::min(travel_m, away_m) >= length_m) {
            return i;
        }
        travel_m += segment.length_m;
    }
    return passed.size();
}

std::vector<PassedSegment> backward(std::span<const PassedSegment> passed) {
    std::vector<PassedSegment> reversed{passed.rbegin(), passed.rend()};
    for (auto& segment : reversed) {
        std::swap(segment.from, segment.to);
    }
    return reversed;
}

} // namespace

std::vector<bool> kept_passes(std::span<const PassedSegment> passed,
                              const std::function<double(std::size_t n)>& draw_m) {
    std::vector<bool> kept(passed.size());
    std::size_t drawn = 0;
    for (std::size_t first = 0; first < passed.size();) {
        std::size_t past = first + 1;
        while (past < passed.size() &&
               passed[past].t_ms - passed[past - 1].t_ms <= longest_pause_ms) {
            ++past;
        }
        const auto drive = passed.subspan(first, past - first);
        const auto before = passes_within(drive, draw_m(drawn++));
        const auto after = passes_within(backward(drive), draw_m(drawn++));
        for (auto i = first + before; i + after < past; ++i) {
            kept[i] = true;
        }
        first = past;
    }
    return kept;
}

} // namespace macadam
