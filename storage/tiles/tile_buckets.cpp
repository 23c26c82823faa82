#include "storage/tiles/tile_buckets.hpp"

#include <algorithm>
#include <cassert>
#include <span>
#include <type_traits>
#include <utility>

namespace macadam {
namespace {

/// Appends values to bytes.
struct Writer {
    std::string& bytes;

    template <typename Value>
    void operator()(const Value& value) const {
        put(&value, 1);
    }
    template <typename Value>
    void operator()(const std::vector<Value>& values) const {
        (*this)(static_cast<std::uint32_t>(values.size()));
        put(values.data(), values.size());
    }

private:
    template <typename Value>
    void put(const Value* values, std::size_t count) const {
        static_assert(std::is_trivially_copyable_v<Value>);
        const auto raw = std::as_bytes(std::span{values, count});
        bytes.append(reinterpret_cast<const char*>(raw.data()), // NOLINT(*-reinterpret-cast)
                     raw.size());
    }
};

/// Removes values from the front of bytes.
struct Reader {
    std::string_view& bytes;

    template <typename Value>
    void operator()(Value& value) const {
        take(&value, 1);
    }
    template <typename Value>
    void operator()(std::vector<Value>& values) const {
        std::uint32_t count = 0;
        (*this)(count);
        values.resize(count);
        take(values.data(), count);
    }

private:
    template <typename Value>
    void take(Value* values, std::size_t count) const {
        const auto room = std::as_writable_bytes(std::span{values, count});
        assert(bytes.size() >= room.size());
        std::ranges::copy(std::as_bytes(std::span{bytes}).first(room.size()), room.begin());
        bytes.remove_prefix(room.size());
    }
};

template <typename Type, typename Of>
concept maybe_const = std::is_same_v<std::remove_const_t<Type>, Of>;

void each_field(const auto& each, maybe_const<TileSegment> auto& segment) {
    each(segment.state);
    each(segment.name);
    each(segment.highway);
    each(segment.from_m);
    each(segment.to_m);
    each(segment.line);
}

void each_field(const auto& each, maybe_const<RoadPart> auto& part) {
    each(part.first);
    each(part.name);
    each(part.highway);
    each(part.is_directed);
    each(part.validity);
    each(part.weight_mm);
    each(part.um_mm);
    each(part.worst_um);
    each(part.passes);
    each(part.last_seen_ms);
    each(part.class_mm);
    each(part.line);
}

template <typename Item>
std::vector<Item> items_in(std::string_view bytes) {
    std::vector<Item> items;
    while (!bytes.empty()) {
        each_field(Reader{bytes}, items.emplace_back());
    }
    return items;
}

} // namespace

void append_to(std::string& bytes, const TileSegment& segment) {
    each_field(Writer{bytes}, segment);
}

std::vector<TileSegment> tile_segments_in(std::string_view bytes) {
    return items_in<TileSegment>(bytes);
}

void append_to(std::string& bytes, const RoadPart& part) {
    each_field(Writer{bytes}, part);
}

std::vector<RoadPart> road_parts_in(std::string_view bytes) {
    return items_in<RoadPart>(bytes);
}

void TileBuckets::settle() {
    for (const auto& [tile, bytes] : open_) {
        places_[tile].push_back(temp_file_->append(bytes));
    }
    open_.clear();
    open_bytes_ = 0;
}

void TileBuckets::put(const TileId& tile, std::string_view bytes) {
    assert(open_.empty());
    if (const auto found = places_.find(tile); found != places_.end()) {
        for (const auto& place : found->second) {
            replaced_bytes_ += place.size;
        }
        places_.erase(found);
    }
    if (!bytes.empty()) {
        places_[tile] = {temp_file_->append(bytes)};
    }
}

void TileBuckets::compact() {
    if (replaced_bytes_ <= max_open_bytes || 2 * replaced_bytes_ <= temp_file_->size()) {
        return;
    }
    auto file = std::make_unique<TempFile>(temp_file_->beside());
    std::map<TileId, std::vector<ByteRange>> places;
    for (const auto& tile : tiles()) {
        places[tile] = {file->append(read(tile))};
    }
    temp_file_ = std::move(file);
    places_ = std::move(places);
    replaced_bytes_ = 0;
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
            bytes += temp_file_->read(place);
        }
    }
    return bytes;
}

} // namespace macadam
