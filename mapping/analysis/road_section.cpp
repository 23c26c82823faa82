#include "mapping/analysis/road_section.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace macadam {
namespace {

constexpr double a_centimetre_m = 0.01; // output resolution of lengths

double shared_m(double from_m, double to_m, const RouteMeasureRange& range) {
    return std::max(0.0, std::min(to_m, range.to_m) - std::max(from_m, range.from_m));
}

double excluded_m(double from_m, double to_m, std::span<const RouteMeasureRange> excluded) {
    const auto* const first =
        std::ranges::upper_bound(excluded, from_m, {}, &RouteMeasureRange::to_m).base();
    double sum_m = 0;
    for (auto i = static_cast<std::size_t>(first - excluded.data());
         i < excluded.size() && excluded[i].from_m < to_m;
         ++i) {
        sum_m += shared_m(from_m, to_m, excluded[i]);
    }
    return sum_m;
}

/// Returns the intervals that overlap the section.
std::span<const RouteSegment> pieces_in(std::span<const RouteSegment> pieces,
                                        const RouteMeasureRange& section) {
    const auto first = std::ranges::upper_bound(pieces, section.from_m, {}, &RouteSegment::to_m);
    const auto last = std::ranges::lower_bound(pieces, section.to_m, {}, &RouteSegment::from_m);
    return first < last ? std::span{first, last} : std::span<const RouteSegment>{};
}

/// Clips an interval to the section, including its way measures.
RouteSegment cut(RouteSegment piece, const RouteMeasureRange& section) {
    const double before_m = std::max(0.0, section.from_m - piece.from_m);
    const double behind_m = std::max(0.0, piece.to_m - section.to_m);
    const bool forward = !piece.segment || piece.segment->forward;
    piece.from_m += before_m;
    piece.to_m -= behind_m;
    piece.way_from_m += forward ? before_m : behind_m;
    piece.way_to_m -= forward ? behind_m : before_m;
    return piece;
}

void add_part(std::vector<StretchPart>& parts, const RouteSegment& piece) {
    const auto& key = *piece.segment;
    if (!parts.empty()) {
        auto& last = parts.back();
        const double apart_m =
            key.forward ? piece.way_from_m - last.to_m : piece.way_to_m - last.from_m;
        if (last.way_id == key.way_id && last.forward == key.forward &&
            std::abs(apart_m) < a_centimetre_m) {
            (key.forward ? last.to_m : last.from_m) =
                key.forward ? piece.way_to_m : piece.way_from_m;
            return;
        }
    }
    parts.push_back({key.way_id, key.forward, piece.way_from_m, piece.way_to_m});
}

RoadSection measured_section(std::span<const RouteSegment> pieces,
                             const SegmentStates& states,
                             const RouteMeasureRange& range,
                             std::span<const RouteMeasureRange> excluded,
                             const ErrorAlongRoad& errors) {
    RoadSection section{};
    section.from_m = range.from_m;
    section.to_m = range.to_m;
    section.excluded_m = excluded_m(range.from_m, range.to_m, excluded);
    std::vector<MeasuredPiece> measured;
    for (const auto& whole : pieces_in(pieces, range)) {
        const auto piece = cut(whole, range);
        if (!piece.segment) {
            continue;
        }
        add_part(section.parts, piece);
        const auto state = states.find(*piece.segment);
        const double length_m =
            piece.to_m - piece.from_m - excluded_m(piece.from_m, piece.to_m, excluded);
        if (state != states.end() && length_m > 0) {
            measured.push_back({length_m, piece.segment_middle_m, &state->second});
        }
    }
    section.measured = measured_road(measured, errors);
    const double open_m = range.to_m - range.from_m - section.excluded_m;
    section.open_share =
        open_m > a_centimetre_m ? std::min(1.0, section.measured.mean.length_m / open_m) : 0;
    return section;
}

} // namespace

std::vector<RouteMeasureRange> even_sections(double whole_m, double length_m) {
    assert(length_m > 0);
    std::vector<RouteMeasureRange> sections;
    for (std::size_t i = 0; static_cast<double>(i) * length_m < whole_m - a_centimetre_m; ++i) {
        const double from_m = static_cast<double>(i) * length_m;
        sections.push_back({from_m, std::min(whole_m, from_m + length_m)});
    }
    return sections;
}

std::vector<RoadSection> measured_sections(const RoadNetwork& roads,
                                           const LinearRoute& road,
                                           const SegmentStates& states,
                                           std::span<const RouteMeasureRange> sections,
                                           std::span<const RouteMeasureRange> excluded,
                                           const ErrorAlongRoad& errors) {
    const auto pieces = pieces_of(roads, road);
    std::vector<RoadSection> measured;
    measured.reserve(sections.size());
    for (const auto& range : sections) {
        measured.push_back(measured_section(pieces, states, range, excluded, errors));
        measured.back().line = line_of(roads, road, range.from_m, range.to_m);
    }
    return measured;
}

} // namespace macadam
