#include "render/tiles/mvt_layer.hpp"

#include "estimator/common/splitmix.hpp"
#include "mapping/geometry/line_clipping.hpp"

#include <protozero/buffer_string.hpp>
#include <protozero/pbf_writer.hpp>
#include <protozero/varint.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <functional>

namespace macadam {
namespace {

// Field numbers of the specification's vector_tile.proto.
namespace tag {
constexpr protozero::pbf_tag_type layer = 3;
constexpr protozero::pbf_tag_type name = 1, feature = 2, key = 3, value = 4, extent = 5;
constexpr protozero::pbf_tag_type version = 15;
constexpr protozero::pbf_tag_type id = 1, tags = 2, type = 3, geometry = 4;
constexpr protozero::pbf_tag_type text = 1, real = 3, whole = 6;
} // namespace tag

// Features and values are encoded by hand: protozero's writers, which reserve space for lengths and
// remove it again, take four times as long.
constexpr char key_of(protozero::pbf_tag_type tag, protozero::pbf_wire_type type) {
    return static_cast<char>(tag << 3U | static_cast<std::uint32_t>(type));
}
constexpr char varint_key(protozero::pbf_tag_type tag) {
    return key_of(tag, protozero::pbf_wire_type::varint);
}
constexpr char bytes_key(protozero::pbf_tag_type tag) {
    return key_of(tag, protozero::pbf_wire_type::length_delimited);
}

constexpr std::size_t max_varint_bytes = 10;

char* put_varint(char* at, std::uint64_t value) {
    for (; value >= 0x80U; value >>= 7U) {
        *at++ = static_cast<char>(value | 0x80U);
    }
    *at++ = static_cast<char>(value);
    return at;
}

std::size_t varint_bytes(std::uint64_t value) {
    return 1 + (static_cast<std::size_t>(std::bit_width(value | 1U)) - 1) / 7;
}

/// Returns the size of a message or text field, including its key and length.
std::size_t field_bytes(std::size_t size) {
    return 1 + varint_bytes(size) + size;
}

constexpr int extent_bits = 12;
static_assert(tile_extent == 1 << extent_bits);
constexpr std::uint32_t line_type = 2, move_command = 1, line_command = 2;

std::uint32_t command(std::uint32_t id, std::size_t count) {
    return (id & 7U) | (static_cast<std::uint32_t>(count) << 3U);
}

std::uint32_t zigzag(std::int32_t value) {
    return (static_cast<std::uint32_t>(value) << 1U) ^ static_cast<std::uint32_t>(value >> 31);
}

/// Mixes the bits: numbers with two decimals share the pattern of their last 40 bits with 1 in 25
/// others.
std::uint64_t mixed(std::uint64_t bits, std::uint64_t kind) {
    return splitmix_mixed(bits ^ (kind << 61U));
}

std::uint32_t upper_half(std::uint64_t hash) {
    return static_cast<std::uint32_t>(hash >> 32U);
}

} // namespace

WorldBox shown_by(const TileId& tile) {
    const auto side = std::int64_t{1} << static_cast<unsigned>(world_bits - tile.zoom);
    const auto buffer = side * tile_buffer / tile_extent;
    const auto held = [](std::int64_t value) {
        return static_cast<std::uint32_t>(
            std::clamp<std::int64_t>(value, 0, (std::int64_t{1} << world_bits) - 1));
    };
    return {held(tile.x * side - buffer),
            held(tile.y * side - buffer),
            held((tile.x + 1) * side + buffer),
            held((tile.y + 1) * side + buffer)};
}

bool meet(const WorldBox& a, const WorldBox& b) {
    return a.min_x <= b.max_x && b.min_x <= a.max_x && a.min_y <= b.max_y && b.min_y <= a.max_y;
}

VectorLayer::VectorLayer(std::string_view name,
                         const TileId& tile,
                         std::span<const std::string_view> keys)
    : name_{name}, keys_{keys}, shift_{world_bits - extent_bits - tile.zoom} {
    assert(shift_ >= 0);
    const auto side = static_cast<unsigned>(world_bits - tile.zoom);
    west_ = std::int64_t{tile.x} << side;
    north_ = std::int64_t{tile.y} << side;
    slots_.resize(4096);
    last_.resize(keys.size(), 0);
    tags_.resize(keys.size() * 2 * max_varint_bytes);
}

// ------------------------------------------------------------------------------------- geometry

VectorLayer::TilePoint VectorLayer::place_of(const WorldPoint& point) const {
    const std::int64_t half = shift_ > 0 ? std::int64_t{1} << (shift_ - 1) : 0;
    return {static_cast<std::int32_t>((std::int64_t{point.x} - west_ + half) >> shift_),
            static_cast<std::int32_t>((std::int64_t{point.y} - north_ + half) >> shift_)};
}

void VectorLayer::move_to(const TilePoint& place) {
    geometry_.push_back(command(move_command, 1));
    geometry_.push_back(zigzag(place.x - cursor_.x));
    geometry_.push_back(zigzag(place.y - cursor_.y));
    cursor_ = place;
}

void VectorLayer::line_to(const TilePoint& place) {
    geometry_.push_back(zigzag(place.x - cursor_.x));
    geometry_.push_back(zigzag(place.y - cursor_.y));
    cursor_ = place;
}

void VectorLayer::end_piece() {
    if (piece_.size() > 1) {
        move_to(piece_.front());
        geometry_.push_back(command(line_command, piece_.size() - 1));
        std::for_each(piece_.begin() + 1, piece_.end(), [&](const TilePoint& p) { line_to(p); });
    }
    piece_.clear();
}

bool VectorLayer::lies_within(const TilePoint& place) {
    constexpr auto is_within = [](std::int32_t at) {
        return at >= -tile_buffer && at <= tile_extent + tile_buffer;
    };
    return is_within(place.x) && is_within(place.y);
}

void VectorLayer::put_clipped(const TilePoint& from, const TilePoint& to) {
    if (lies_within(from) && lies_within(to)) { // the usual case
        go_on(from, to);
        return;
    }
    const double dx = to.x - from.x, dy = to.y - from.y;
    constexpr double low = -tile_buffer, high = tile_extent + tile_buffer;
    const auto part = clipped_line(from, to, {low, low, high, high});
    if (part.is_empty()) {
        end_piece();
        return;
    }
    const auto at = [&](double share) {
        return TilePoint{static_cast<std::int32_t>(std::lround(from.x + share * dx)),
                         static_cast<std::int32_t>(std::lround(from.y + share * dy))};
    };
    go_on(at(part.from), at(part.to));
}

void VectorLayer::go_on(const TilePoint& begin, const TilePoint& end) {
    if (piece_.empty() || piece_.back() != begin) {
        end_piece();
        piece_.push_back(begin);
    }
    if (piece_.back() != end) {
        piece_.push_back(end);
    }
}

void VectorLayer::put_line(std::span<const TilePoint> line) {
    for (std::size_t i = 1; i < line.size(); ++i) {
        put_clipped(line[i - 1], line[i]);
    }
    end_piece();
}

bool VectorLayer::begin(std::span<const WorldPoint> line) {
    assert(!line.empty());
    geometry_.clear();
    tag_bytes_ = 0;
    cursor_ = {0, 0};
    line_.clear();
    for (const auto& point : line) {
        if (const auto place = place_of(point); line_.empty() || line_.back() != place) {
            line_.push_back(place);
        }
    }
    if (line_.size() == 1) {
        line_.push_back({line_.front().x + 1, line_.front().y});
    }
    put_line(line_);
    return !geometry_.empty();
}

// --------------------------------------------------------------------------------------- values

std::uint32_t VectorLayer::put_value(Value::Kind kind, std::uint64_t bits, std::string_view text) {
    std::array<char, 4 * max_varint_bytes> head;
    auto* at = head.data();
    *at++ = bytes_key(tag::value);
    switch (kind) {
    case Value::Kind::text:
    case Value::Kind::unlike:
        at = put_varint(at, field_bytes(text.size()));
        *at++ = bytes_key(tag::text);
        at = put_varint(at, text.size());
        break;
    case Value::Kind::whole: {
        const auto folded = protozero::encode_zigzag64(static_cast<std::int64_t>(bits));
        at = put_varint(at, 1 + varint_bytes(folded));
        *at++ = varint_key(tag::whole);
        at = put_varint(at, folded);
        break;
    }
    case Value::Kind::real:
        static_assert(std::endian::native == std::endian::little);
        at = put_varint(at, 1 + sizeof bits);
        *at++ = key_of(tag::real, protozero::pbf_wire_type::fixed64);
        std::memcpy(at, &bits, sizeof bits);
        at += sizeof bits;
        break;
    }
    values_.append(head.data(), at);
    values_ += text; // end of the message
    const auto size = static_cast<std::uint32_t>(text.size());
    known_.push_back({kind, bits, static_cast<std::uint32_t>(values_.size()) - size, size});
    return static_cast<std::uint32_t>(known_.size()) - 1;
}

void VectorLayer::make_room() {
    slots_.assign(slots_.size() * 4, {});
    const auto mask = slots_.size() - 1;
    for (std::size_t i = 0; i < known_.size(); ++i) {
        if (known_[i].kind == Value::Kind::unlike) {
            continue;
        }
        const auto hash = mixed(known_[i].bits, static_cast<std::uint64_t>(known_[i].kind));
        auto slot = hash & mask;
        while (slots_[slot].number != 0) {
            slot = (slot + 1) & mask;
        }
        slots_[slot] = {static_cast<std::uint32_t>(i) + 1, upper_half(hash)};
    }
}

std::uint32_t VectorLayer::number_of(Value::Kind kind, std::uint64_t bits, std::string_view text) {
    if (2 * known_.size() > slots_.size()) {
        make_room();
    }
    const auto hash = mixed(bits, static_cast<std::uint64_t>(kind));
    const auto mask = slots_.size() - 1;
    auto slot = hash & mask;
    for (; slots_[slot].number != 0; slot = (slot + 1) & mask) {
        const auto number = slots_[slot].number - 1;
        const auto& value = known_[number];
        if (slots_[slot].hash == upper_half(hash) && value.kind == kind && value.bits == bits &&
            text_of(value) == text) {
            return number;
        }
    }
    const auto number = put_value(kind, bits, text);
    slots_[slot] = {number + 1, upper_half(hash)};
    return number;
}

std::string_view VectorLayer::text_of(const Value& value) const {
    return std::string_view{values_}.substr(value.at, value.size);
}

void VectorLayer::put_tag(std::uint32_t key, std::uint32_t value) {
    assert(tag_bytes_ + 2 * max_varint_bytes <= tags_.size()); // each key once
    auto* const at = tags_.data() + tag_bytes_;
    tag_bytes_ += static_cast<std::size_t>(put_varint(put_varint(at, key), value) - at);
    last_[key] = value + 1;
}

/// Reuses the last value of a key without a look-up, since neighbours share most values.
bool VectorLayer::repeat_last(std::uint32_t key, Value::Kind kind, std::uint64_t bits) {
    const auto last = last_[key];
    const bool is_alike =
        last != 0 && known_[last - 1].kind == kind && known_[last - 1].bits == bits;
    if (is_alike) {
        put_tag(key, last - 1);
    }
    return is_alike;
}

bool VectorLayer::repeat_last(std::uint32_t key, std::string_view text) {
    const auto last = last_[key];
    const bool is_alike = last != 0 && known_[last - 1].kind == Value::Kind::text &&
                          text_of(known_[last - 1]) == text;
    if (is_alike) {
        put_tag(key, last - 1);
    }
    return is_alike;
}

void VectorLayer::add(std::uint32_t key, std::string_view text) {
    if (!repeat_last(key, text)) {
        put_tag(key, number_of(Value::Kind::text, std::hash<std::string_view>{}(text), text));
    }
}

void VectorLayer::add(std::uint32_t key, std::int64_t whole) {
    const auto bits = static_cast<std::uint64_t>(whole);
    if (!repeat_last(key, Value::Kind::whole, bits)) {
        put_tag(key, number_of(Value::Kind::whole, bits, {}));
    }
}

void VectorLayer::add_real(std::uint32_t key, double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value + 0.0); // maps -0 to 0
    if (!repeat_last(key, Value::Kind::real, bits)) {
        put_tag(key, number_of(Value::Kind::real, bits, {}));
    }
}

void VectorLayer::add_unlike(std::uint32_t key, std::string_view text) {
    put_tag(key, put_value(Value::Kind::unlike, 0, text));
}

// ------------------------------------------------------------------------------------- features

void VectorLayer::end(std::optional<std::uint64_t> id) {
    std::size_t geometry_bytes = 0;
    for (const auto number : geometry_) {
        geometry_bytes += varint_bytes(number);
    }
    constexpr std::size_t type_bytes = 2;
    const auto size = (id ? 1 + varint_bytes(*id) : 0) + field_bytes(tag_bytes_) + type_bytes +
                      field_bytes(geometry_bytes);
    const auto before = features_.size();
    features_.resize(before + field_bytes(size));
    auto* at = features_.data() + before;
    *at++ = bytes_key(tag::feature);
    at = put_varint(at, size);
    if (id) {
        *at++ = varint_key(tag::id);
        at = put_varint(at, *id);
    }
    *at++ = bytes_key(tag::tags);
    at = put_varint(at, tag_bytes_);
    at = std::copy_n(tags_.data(), tag_bytes_, at);
    *at++ = varint_key(tag::type);
    at = put_varint(at, line_type);
    *at++ = bytes_key(tag::geometry);
    at = put_varint(at, geometry_bytes);
    for (const auto number : geometry_) {
        at = put_varint(at, number);
    }
    assert(at == features_.data() + features_.size());
    ++count_;
}

std::string VectorLayer::tile_bytes() const {
    std::string layer;
    protozero::pbf_writer writer{layer};
    writer.add_uint32(tag::version, 2);
    writer.add_string(tag::name, name_);
    layer += features_;
    for (const auto key : keys_) {
        writer.add_string(tag::key, key.data(), key.size());
    }
    layer += values_;
    writer.add_uint32(tag::extent, tile_extent);
    std::string tile;
    protozero::pbf_writer{tile}.add_message(tag::layer, layer);
    return tile;
}

} // namespace macadam
