#include "mapping/conflation/segment_correspondence.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace macadam {
namespace {

constexpr double unchanged_m = 0.1; // accumulated rounding to whole millimetres over many ways

/// Returns the boundary before segment `number` of the link, from the way's first node.
double border_m(const Link& link, std::uint32_t number) {
    return number == link.segments
               ? link.to_m
               : link.from_m + (link.to_m - link.from_m) * number / link.segments;
}

WayMeasureRange stations(bool forward, double from_m, double to_m) {
    return forward ? WayMeasureRange{from_m, to_m} : WayMeasureRange{-to_m, -from_m};
}

bool may_drive(const WayView& way, bool forward) {
    return way.oneway != (forward ? Oneway::backward : Oneway::forward);
}

std::uint32_t segments_of_way(const RoadNetwork& roads, const WayView& way) {
    const auto last = link_at(roads, LinkId{way.past_link - 1});
    return last.first_segment + last.segments;
}

/// Returns the link of a way that contains an existing segment number.
Link link_with(const RoadNetwork& roads, const WayView& way, std::uint32_t index) {
    auto first = way.first_link;
    auto past = way.past_link;
    while (past - first > 1) {
        const auto middle = first + (past - first) / 2;
        (roads.links[middle].first_segment <= index ? first : past) = middle;
    }
    return link_at(roads, LinkId{first});
}

struct MeasuredSegment {
    SegmentKey key;
    WayMeasureRange whole_m;
};

/// Returns the segments of a way that overlap a range of stations, in driving direction.
std::vector<MeasuredSegment> segments_in(const RoadNetwork& roads,
                                         const WayView& way,
                                         bool forward,
                                         const WayMeasureRange& range) {
    const auto along = stations(forward, range.from_m, range.to_m);
    std::vector<MeasuredSegment> segments;
    for (auto i = way.first_link; i < way.past_link; ++i) {
        const auto link = link_at(roads, LinkId{i});
        if (link.to_m <= along.from_m || link.from_m >= along.to_m) {
            continue;
        }
        for (std::uint32_t k = 0; k < link.segments; ++k) {
            const double from_m = border_m(link, k);
            const double to_m = border_m(link, k + 1);
            if (from_m < along.to_m && to_m > along.from_m) {
                segments.push_back(
                    {{way.id, forward, link.first_segment + k}, stations(forward, from_m, to_m)});
            }
        }
    }
    if (!forward) {
        std::ranges::reverse(segments);
    }
    return segments;
}

WayMeasureRange shared(const WayMeasureRange& a, const WayMeasureRange& b) {
    return {std::max(a.from_m, b.from_m), std::min(a.to_m, b.to_m)};
}

/// Maps a range of stations from one side of a correspondence to the other.
WayMeasureRange
over(const WayMeasureRange& range, const DirectedPart& here, const DirectedPart& there) {
    const double scale =
        (there.to_station_m - there.from_station_m) / (here.to_station_m - here.from_station_m);
    const auto at = [&](double station_m) {
        return there.from_station_m + scale * (station_m - here.from_station_m);
    };
    return {at(range.from_m), at(range.to_m)};
}

/// Returns the correspondences of a way in one direction.
auto roads_of(const NetworkChange& change, std::int64_t way_id, bool forward) {
    const auto key_of = [](const RoadCorrespondence& road) {
        return std::tuple{road.before.way_id, !road.before.forward};
    };
    return std::ranges::equal_range(change.same, std::tuple{way_id, !forward}, {}, key_of);
}

bool are_near(const WayMeasureRange& a, const WayMeasureRange& b) {
    return std::abs(a.from_m - b.from_m) <= unchanged_m && std::abs(a.to_m - b.to_m) <= unchanged_m;
}

} // namespace

std::optional<std::uint32_t> way_numbered(const RoadNetwork& roads, std::int64_t id) {
    const auto past = roads.ways.begin() + way_count(roads);
    const auto found = std::ranges::lower_bound(roads.ways.begin(), past, id, {}, &PackedWay::id);
    return found != past && found->id == id
               ? std::optional{static_cast<std::uint32_t>(found - roads.ways.begin())}
               : std::nullopt;
}

std::optional<WayMeasureRange> stations_of(const RoadNetwork& roads, const SegmentKey& key) {
    const auto number = way_numbered(roads, key.way_id);
    if (!number) {
        return std::nullopt;
    }
    const auto way = way_at(roads, *number);
    if (!may_drive(way, key.forward) || key.index >= segments_of_way(roads, way)) {
        return std::nullopt;
    }
    const auto link = link_with(roads, way, key.index);
    const auto within = key.index - link.first_segment;
    return stations(key.forward, border_m(link, within), border_m(link, within + 1));
}

std::uint32_t segments_of_chunk(const RoadNetwork& roads, const ChunkKey& chunk) {
    const auto number = way_numbered(roads, chunk.way_id);
    const auto length = segments_per_chunk(roads.segment_length_m);
    const auto all = number ? segments_of_way(roads, way_at(roads, *number)) : 0;
    const auto first = chunk.number * length;
    return first < all ? std::min(length, all - first) : 0;
}

SegmentCorrespondences::SegmentCorrespondences(const RoadNetwork& before,
                                               const RoadNetwork& after,
                                               const NetworkChange& change)
    : before_{&before}, after_{&after}, change_{&change} {}

bool SegmentCorrespondences::is_kept(std::int64_t way_id) const {
    return std::ranges::binary_search(change_->kept, way_id);
}

std::optional<DirectedPart> SegmentCorrespondences::stretch(const DirectedPart& before) const {
    constexpr double min_share = 0.9;
    if (is_kept(before.way_id)) {
        return before;
    }
    const WayMeasureRange whole{before.from_station_m, before.to_station_m};
    std::optional<DirectedPart> found;
    double found_m = 0;
    for (const auto& road : roads_of(*change_, before.way_id, before.forward)) {
        const auto old = shared(whole, {road.before.from_station_m, road.before.to_station_m});
        if (!(old.to_m > old.from_m)) {
            continue;
        }
        const auto now = over(old, road.before, road.after);
        if (found && (found->way_id != road.after.way_id || found->forward != road.after.forward ||
                      now.from_m < found->from_station_m)) {
            return std::nullopt;
        }
        found = DirectedPart{road.after.way_id,
                             road.after.forward,
                             found ? found->from_station_m : now.from_m,
                             now.to_m};
        found_m += length_m(old);
    }
    return found_m >= min_share * length_m(whole) ? found : std::nullopt;
}

std::vector<SegmentCorrespondence> SegmentCorrespondences::of(const SegmentKey& before) const {
    const auto whole = stations_of(*before_, before);
    if (!whole) {
        return {};
    }
    if (is_kept(before.way_id)) {
        return {{before, *whole, *whole, *whole}};
    }
    std::vector<SegmentCorrespondence> correspondences;
    for (const auto& road : roads_of(*change_, before.way_id, before.forward)) {
        const auto old = shared(*whole, {road.before.from_station_m, road.before.to_station_m});
        if (!(old.to_m > old.from_m)) {
            continue;
        }
        const auto now = over(old, road.before, road.after);
        const auto way = way_at(*after_, *way_numbered(*after_, road.after.way_id));
        for (const auto& segment : segments_in(*after_, way, road.after.forward, now)) {
            const auto part = shared(now, segment.whole_m);
            correspondences.push_back(
                {segment.key, over(part, road.after, road.before), part, segment.whole_m});
        }
    }
    return correspondences;
}

std::optional<SegmentCorrespondence>
SegmentCorrespondences::unchanged(const SegmentKey& before) const {
    const auto whole = stations_of(*before_, before);
    auto correspondences = of(before);
    std::erase_if(correspondences, [](const SegmentCorrespondence& correspondence) {
        return length_m(correspondence.after_m) <= unchanged_m;
    });
    const bool is_one = correspondences.size() == 1 &&
                        are_near(correspondences[0].before_m, *whole) &&
                        are_near(correspondences[0].after_m, correspondences[0].whole_m);
    return is_one ? std::optional{correspondences.front()} : std::nullopt;
}

std::optional<ShiftedChunk> SegmentCorrespondences::moved(const ChunkKey& before) const {
    const auto segment_length_m = before_->segment_length_m;
    const auto count = segments_of_chunk(*before_, before);
    const auto first = before.number * segments_per_chunk(segment_length_m);
    std::optional<ShiftedChunk> chunk;
    for (auto index = first; index < first + count; ++index) {
        const auto correspondence = unchanged({before.way_id, before.forward, index});
        if (!correspondence) {
            return std::nullopt;
        }
        const ShiftedChunk to{chunk_of(correspondence->after, segment_length_m),
                              correspondence->after_m.from_m - correspondence->before_m.from_m};
        if (chunk &&
            (chunk->chunk != to.chunk || std::abs(chunk->shift_m - to.shift_m) > unchanged_m)) {
            return std::nullopt;
        }
        chunk = chunk ? chunk : to;
    }
    const bool is_whole = chunk && segments_of_chunk(*after_, chunk->chunk) == count;
    return is_whole ? chunk : std::nullopt;
}

} // namespace macadam
