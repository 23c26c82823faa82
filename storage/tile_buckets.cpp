#include "storage/tile_buckets.hpp"

#include <cassert>
#include <cstring>
#include <type_traits>

namespace macadam {
namespace {

template <typename Value>
void put(std::string& bytes, const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value); // NOLINT(*-reinterpret-cast)
}

template <typename Value>
void put_all(std::string& bytes, const std::vector<Value>& values) {
    put(bytes, static_cast<std::uint32_t>(values.size()));
    for (const auto& value : values) {
        put(bytes, value);
    }
}

template <typename Value>
Value take(std::string_view& bytes) {
    assert(bytes.size() >= sizeof(Value));
    Value value;
    std::memcpy(&value, bytes.data(), sizeof value);
    bytes.remove_prefix(sizeof value);
    return value;
}

template <typename Value>
std::vector<Value> take_all(std::string_view& bytes) {
    std::vector<Value> values(take<std::uint32_t>(bytes));
    for (auto& value : values) {
        value = take<Value>(bytes);
    }
    return values;
}

} // namespace

void append_to(std::string& bytes, const TileSegment& segment) {
    put(bytes, segment.state);
    put(bytes, segment.name);
    put(bytes, segment.highway);
    put(bytes, segment.from_m);
    put(bytes, segment.to_m);
    put_all(bytes, segment.line);
}

std::vector<TileSegment> tile_segments_in(std::string_view bytes) {
    std::vector<TileSegment> segments;
    while (!bytes.empty()) {
        auto& segment = segments.emplace_back();
        segment.state = take<SegmentState>(bytes);
        segment.name = take<std::uint32_t>(bytes);
        segment.highway = take<std::uint32_t>(bytes);
        segment.from_m = take<double>(bytes);
        segment.to_m = take<double>(bytes);
        segment.line = take_all<WorldPoint>(bytes);
    }
    return segments;
}

void append_to(std::string& bytes, const RoadPart& part) {
    put(bytes, part.first);
    put(bytes, part.name);
    put(bytes, part.highway);
    put(bytes, part.is_directed);
    put(bytes, part.validity);
    put(bytes, part.weight_mm);
    put(bytes, part.um_mm);
    put(bytes, part.worst_um);
    put(bytes, part.passes);
    put(bytes, part.last_seen_ms);
    put_all(bytes, part.class_mm);
    put_all(bytes, part.line);
}

std::vector<RoadPart> road_parts_in(std::string_view bytes) {
    std::vector<RoadPart> parts;
    while (!bytes.empty()) {
        auto& part = parts.emplace_back();
        part.first = take<SegmentKey>(bytes);
        part.name = take<std::uint32_t>(bytes);
        part.highway = take<std::uint32_t>(bytes);
        part.is_directed = take<bool>(bytes);
        part.validity = take<std::uint8_t>(bytes);
        part.weight_mm = take<std::int64_t>(bytes);
        part.um_mm = take<std::int64_t>(bytes);
        part.worst_um = take<IriUm>(bytes);
        part.passes = take<std::int32_t>(bytes);
        part.last_seen_ms = take<std::optional<std::int64_t>>(bytes);
        part.class_mm = take_all<std::int64_t>(bytes);
        part.line = take_all<WorldPoint>(bytes);
    }
    return parts;
}

void TileBuckets::settle() {
    for (const auto& [tile, bytes] : open_) {
        places_[tile].push_back(spool_.append(bytes));
    }
    open_.clear();
    open_bytes_ = 0;
}

std::vector<TileId> TileBuckets::tiles() const {
    std::vector<TileId> tiles;
    tiles.reserve(places_.size());
    for (const auto& [tile, places] : places_) {
        tiles.push_back(tile);
    }
    return tiles;
}

std::string TileBuckets::read(const TileId& tile) const {
    assert(open_.empty());
    std::string bytes;
    if (const auto found = places_.find(tile); found != places_.end()) {
        for (const auto& place : found->second) {
            bytes += spool_.read(place);
        }
    }
    return bytes;
}

} // namespace macadam
