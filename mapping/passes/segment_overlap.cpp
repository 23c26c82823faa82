#include "mapping/passes/segment_overlap.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <tuple>

namespace macadam {
namespace {

// Default without a stated sd: positions with a speed sensor, as measured
// (docs/method/matching.md).
constexpr double usual_place_sd_m = 2.5;

constexpr double longest_silence_m = 20;
constexpr double min_step_back_m = 0.5; // less is rounding

double share(double value, double from, double to) {
    return (value - from) / (to - from);
}

/// Returns the part of an interval between two offsets along its edge.
SegmentOverlap
part_of(const MatchedInterval& piece, const SegmentOverlap& segment, double a, double b) {
    const double first = share(a, piece.from_offset_m, piece.to_offset_m);
    const double last = share(b, piece.from_offset_m, piece.to_offset_m);
    auto part = segment;
    part.from_station_m += a;
    part.to_station_m += b;
    part.travel = {std::lerp(piece.from_travel_m, piece.to_travel_m, first),
                   std::lerp(piece.from_travel_m, piece.to_travel_m, last)};
    part.t_enter_s = std::lerp(piece.t_enter_s, piece.t_leave_s, first);
    part.t_leave_s = std::lerp(piece.t_enter_s, piece.t_leave_s, last);
    part.confidence = piece.confidence;
    part.place_sd_m = piece.offset_sd_m > 0 ? piece.offset_sd_m : usual_place_sd_m;
    return part;
}

/// Cuts a road interval at segment boundaries, in driving direction.
std::vector<SegmentOverlap> parts_of(const MatchedInterval& piece, const RoadNetwork& roads) {
    std::vector<SegmentOverlap> parts;
    const auto link = link_at(roads, piece.edge);
    const bool forward = is_forward(piece.edge);
    const double segment_m = (link.to_m - link.from_m) / link.segments;
    const double start_m = station_m(forward, forward ? link.from_m : link.to_m);
    const auto first =
        static_cast<std::uint32_t>(std::max(0.0, piece.from_offset_m / segment_m - 1));
    for (auto i = first; i < link.segments && i * segment_m < piece.to_offset_m; ++i) {
        const double a = std::max(piece.from_offset_m, i * segment_m);
        const double b = std::min(piece.to_offset_m, (i + 1) * segment_m);
        if (a < b) {
            const auto along = forward ? i : link.segments - 1 - i;
            SegmentOverlap segment{};
            segment.segment = {way_of(roads, piece.edge).id, forward, link.first_segment + along};
            segment.segment_m = segment_m;
            segment.from_station_m = segment.to_station_m = start_m;
            parts.push_back(part_of(piece, segment, a, b));
        }
    }
    return parts;
}

bool goes_on(const SegmentOverlap& before, const SegmentOverlap& part) {
    const double road_m = part.from_station_m - before.to_station_m;
    return road_m >= -min_step_back_m && road_m <= longest_silence_m &&
           part.travel.from_m - before.travel.to_m <= longest_silence_m;
}

} // namespace

std::vector<SegmentOverlap>
driven_parts(const MatchedTrace& matched, const RoadNetwork& roads, double min_confidence) {
    std::vector<SegmentOverlap> parts;
    for (const auto& piece : matched) {
        if (piece.kind == IntervalKind::road) {
            std::ranges::move(parts_of(piece, roads), std::back_inserter(parts));
        }
    }
    std::map<std::tuple<std::int64_t, bool, std::uint32_t>, std::uint32_t> drives;
    const SegmentOverlap* before = nullptr;
    for (auto& part : parts) {
        if (part.confidence < min_confidence) {
            continue;
        }
        const auto chunk = chunk_of(part.segment, roads.segment_length_m);
        const bool same = before != nullptr && goes_on(*before, part) &&
                          chunk_of(before->segment, roads.segment_length_m) == chunk;
        auto& count = drives[{chunk.way_id, chunk.forward, chunk.number}];
        part.drive = same ? before->drive : count++;
        before = &part;
    }
    return parts;
}

} // namespace macadam
