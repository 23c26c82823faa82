#include "mapping/tiles/tile_features.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace macadam {
namespace {

constexpr int measured_zoom = 20; // its tiles are 4096 world units wide
constexpr double units_in_tile = 4096;

std::uint32_t units(double tiles) {
    constexpr double most = std::numeric_limits<std::uint32_t>::max();
    return static_cast<std::uint32_t>(std::llround(std::clamp(tiles * units_in_tile, 0.0, most)));
}

std::uint32_t halfway(std::uint32_t a, std::uint32_t b) {
    return std::midpoint(std::min(a, b), std::max(a, b));
}

RoadPart part_of(const TileSegment& segment, const ClassTable& table) {
    const auto& state = segment.state;
    RoadPart part{.first = state.segment,
                  .name = segment.name,
                  .highway = segment.highway,
                  .is_directed = true,
                  .validity = state.validity,
                  .weight_mm = std::llround((segment.to_m - segment.from_m) * 1000),
                  .um_mm = 0,
                  .worst_um = state.iri_um,
                  .passes = state.passes,
                  .last_seen_ms = state.last_seen_ms,
                  .class_mm = std::vector<std::int64_t>(table.classes.size(), 0),
                  .line = segment.line};
    part.um_mm = part.weight_mm * state.iri_um;
    part.class_mm[class_index(table, state.iri_um / 1000.0)] = part.weight_mm;
    return part;
}

bool is_same_piece(const RoadPart& a, const RoadPart& b) {
    return a.first.way_id == b.first.way_id && a.first.index == b.first.index;
}

/// Merges both directions of one part, showing the rougher one.
RoadPart worse_of(const RoadPart& forward, const RoadPart& backward) {
    const bool is_forward_worse = forward.um_mm >= backward.um_mm; // of equal length
    auto part = is_forward_worse ? forward : backward;
    const auto& other = is_forward_worse ? backward : forward;
    part.first = std::min(forward.first, backward.first);
    part.line = forward.line;
    part.last_seen_ms = std::max(forward.last_seen_ms, backward.last_seen_ms);
    std::ranges::transform(part.class_mm, other.class_mm, part.class_mm.begin(), std::plus<>{});
    return part;
}

} // namespace

WorldPoint world_point(const GeoPoint& point) {
    const auto place = tile_position(point, measured_zoom);
    return {units(place.x), units(place.y)};
}

WorldBox box_of(std::span<const WorldPoint> line) {
    assert(!line.empty());
    WorldBox box{line[0].x, line[0].y, line[0].x, line[0].y};
    for (const auto& point : line) {
        box = {std::min(box.min_x, point.x),
               std::min(box.min_y, point.y),
               std::max(box.max_x, point.x),
               std::max(box.max_y, point.y)};
    }
    return box;
}

TileId tile_at(const WorldPoint& point, int zoom) {
    const auto within = static_cast<unsigned>(world_bits - zoom);
    return {static_cast<std::uint8_t>(zoom),
            static_cast<std::uint32_t>(std::uint64_t{point.x} >> within),
            static_cast<std::uint32_t>(std::uint64_t{point.y} >> within)};
}

std::uint32_t TileWords::number_of(std::string_view word) {
    for (const auto number : recent_) {
        if (words_[number] == word) {
            return number;
        }
    }
    const auto number = number_in_table(word);
    recent_ = {number, recent_.front()};
    return number;
}

std::uint32_t TileWords::number_in_table(std::string_view word) {
    if (const auto known = numbers_.find(word); known != numbers_.end()) {
        return known->second;
    }
    const auto number = static_cast<std::uint32_t>(words_.size());
    numbers_.emplace(words_.emplace_back(word), number);
    return number;
}

TileSegment tile_segment(const SegmentRecord& record, TileWords& words) {
    TileSegment segment{.state = *record.state,
                        .name = words.number_of(record.name),
                        .highway = words.number_of(record.highway),
                        .from_m = record.segment.from_m,
                        .to_m = record.segment.to_m,
                        .line = {}};
    segment.line.reserve(record.segment.line.size());
    for (const auto& point : record.segment.line) {
        segment.line.push_back(world_point(point));
    }
    return segment;
}

WorldPoint middle_of(const TileSegment& segment) {
    const auto &a = segment.line.front(), &b = segment.line.back();
    return {halfway(a.x, b.x), halfway(a.y, b.y)};
}

double iri_of(const RoadPart& part) {
    return part.weight_mm > 0
               ? static_cast<double>(part.um_mm) / static_cast<double>(part.weight_mm) / 1000
               : part.worst_um / 1000.0;
}

std::size_t class_of(const RoadPart& part, const ClassTable& table) {
    return class_index(table, iri_of(part));
}

std::int64_t length_mm(const RoadPart& part) {
    return std::reduce(part.class_mm.begin(), part.class_mm.end());
}

void add_values(RoadPart& part, const RoadPart& other) {
    part.first = std::min(part.first, other.first);
    part.validity &= other.validity;
    part.weight_mm += other.weight_mm;
    part.um_mm += other.um_mm;
    part.worst_um = std::max(part.worst_um, other.worst_um);
    part.passes = std::min(part.passes, other.passes);
    part.last_seen_ms = std::max(part.last_seen_ms, other.last_seen_ms); // std::nullopt is lowest
    std::ranges::transform(part.class_mm, other.class_mm, part.class_mm.begin(), std::plus<>{});
}

std::vector<RoadPart> parts_of(std::span<const TileSegment> segments, const ClassTable& table) {
    std::vector<RoadPart> parts;
    parts.reserve(segments.size());
    for (const auto& segment : segments) {
        parts.push_back(part_of(segment, table));
    }
    return parts;
}

std::vector<RoadPart> parts_of_both_ways(std::span<const TileSegment> segments,
                                         const ClassTable& table) {
    auto parts = parts_of(segments, table);
    std::ranges::sort(parts, {}, [](const RoadPart& part) {
        return std::tuple{part.first.way_id, part.first.index, !part.first.forward};
    });
    std::vector<RoadPart> merged;
    for (auto& part : parts) {
        if (!merged.empty() && is_same_piece(merged.back(), part)) {
            merged.back() = worse_of(merged.back(), part);
            merged.back().is_directed = false;
            continue;
        }
        if (!part.first.forward) {
            std::ranges::reverse(part.line);
        }
        part.is_directed = false;
        merged.push_back(std::move(part));
    }
    return merged;
}

} // namespace macadam
