#include "mapping/matching/edge_traversals.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double meet_m = 1; // intervals with a smaller difference of offset are contiguous

double long_m(const MatchedInterval& piece) {
    return piece.to_offset_m - piece.from_offset_m;
}

bool goes_on(const MatchedInterval& before, const MatchedInterval& piece) {
    if (before.kind != piece.kind) {
        return false;
    }
    if (piece.kind != IntervalKind::road) {
        return before.reason == piece.reason;
    }
    return before.edge == piece.edge && std::abs(piece.from_offset_m - before.to_offset_m) < meet_m;
}

void append(MatchedInterval& traversal, const MatchedInterval& piece) {
    const double whole_m = long_m(traversal) + long_m(piece);
    const double share = whole_m > 0 ? long_m(piece) / whole_m : 0;
    traversal.confidence = std::lerp(traversal.confidence, piece.confidence, share);
    traversal.to_travel_m = piece.to_travel_m;
    traversal.to_offset_m = std::max(traversal.to_offset_m, piece.to_offset_m);
    traversal.t_leave_s = piece.t_leave_s;
    traversal.offset_sd_m = std::max(traversal.offset_sd_m, piece.offset_sd_m);
}

} // namespace

MatchedTrace edge_traversals(const MatchedTrace& trace, double min_m) {
    MatchedTrace joined;
    for (const auto& piece : trace) {
        if (!joined.empty() && goes_on(joined.back(), piece)) {
            append(joined.back(), piece);
        } else {
            joined.push_back(piece);
        }
    }
    MatchedTrace traversals;
    for (auto& piece : joined) {
        const double gone_m = piece.kind == IntervalKind::road
                                  ? long_m(piece)
                                  : piece.to_travel_m - piece.from_travel_m;
        const bool is_speck = gone_m < min_m;
        if (is_speck && !traversals.empty()) {
            traversals.back().to_travel_m = piece.to_travel_m;
            traversals.back().t_leave_s = piece.t_leave_s;
        } else if (!is_speck) {
            if (traversals.empty()) { // tiny intervals before the first traversal
                piece.from_travel_m = joined.front().from_travel_m;
                piece.t_enter_s = joined.front().t_enter_s;
            }
            traversals.push_back(std::move(piece));
        }
    }
    return traversals;
}

} // namespace macadam
