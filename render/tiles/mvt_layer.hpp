#pragma once

#include "mapping/tiles/tile_features.hpp"
#include "mapping/tiles/tile_grid.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

inline constexpr int tile_extent = 4096; ///< units across a vector tile
inline constexpr int tile_buffer = 64;   ///< margin around a tile, in units: 4 px of 256

/// Returns the world units that a tile shows, including its buffer.
WorldBox shown_by(const TileId& tile);
bool meet(const WorldBox& a, const WorldBox& b);

/// Encoder of one layer of lines of a Mapbox Vector Tile, version 2.1. Features are written
/// sequentially: begin(), their properties, end(). Equal values are stored once.
///
/// Source: Mapbox Vector Tile Specification, version 2.1, 4.
class VectorLayer {
public:
    /// \param tile  of zoom 0 to 20.
    /// \param keys  names of the properties, which are referenced by index.
    VectorLayer(std::string_view name, const TileId& tile, std::span<const std::string_view> keys);

    /// Begins a feature with the line clipped to the tile's buffer, in the tile's units. A line
    /// smaller than a unit is drawn one unit long. \returns false, without beginning a feature, if
    /// the line is outside. \param line  at least one point.
    bool begin(std::span<const WorldPoint> line);

    void add(std::uint32_t key, std::string_view text);
    void add(std::uint32_t key, std::int64_t whole);
    void add_real(std::uint32_t key,
                  double value); ///< round first: equal values must be bit-identical
    void add_unlike(std::uint32_t key, std::string_view text); ///< not shared with other features

    void end(std::optional<std::uint64_t> id);

    std::size_t count() const { return count_; } ///< number of features
    std::string tile_bytes() const;              ///< uncompressed tile with only this layer

private:
    struct Value {
        enum class Kind : std::uint8_t {
            text,
            whole,
            real,
            unlike
        } kind;                 ///< unlike: a text that is not looked up
        std::uint64_t bits;     ///< of a number; hash of a text
        std::uint32_t at, size; ///< in values_
    };
    struct Slot {
        std::uint32_t number; ///< value number plus 1; 0 is free
        std::uint32_t hash;   ///< bits not implied by the position of the slot
    };
    struct TilePoint {
        std::int32_t x, y;
        friend bool operator==(const TilePoint&, const TilePoint&) = default;
    };

    TilePoint place_of(const WorldPoint& point) const;
    void put_line(std::span<const TilePoint> line);
    static bool lies_within(const TilePoint& place);
    void put_clipped(const TilePoint& from, const TilePoint& to);
    void go_on(const TilePoint& begin, const TilePoint& end);
    void move_to(const TilePoint& place);
    void line_to(const TilePoint& place);
    void end_piece();

    bool repeat_last(std::uint32_t key, Value::Kind kind, std::uint64_t bits);
    bool repeat_last(std::uint32_t key, std::string_view text);
    void put_tag(std::uint32_t key, std::uint32_t value);
    std::string_view text_of(const Value& value) const;
    std::uint32_t number_of(Value::Kind kind, std::uint64_t bits, std::string_view text);
    std::uint32_t put_value(Value::Kind kind, std::uint64_t bits, std::string_view text);
    void make_room();

    std::string name_;
    std::span<const std::string_view> keys_;
    std::int64_t west_, north_; ///< of the tile, in world units
    int shift_;                 ///< from world units to the tile's
    std::string features_;      ///< encoded sequentially
    std::string values_;        ///< encoded sequentially
    std::vector<Value> known_;
    std::vector<Slot> slots_;             ///< by hash
    std::vector<std::uint32_t> last_;     ///< by key: last value number plus 1
    std::vector<std::uint32_t> geometry_; ///< of the current feature
    std::vector<char> tags_;    ///< of the current feature, encoded, with room for every key once
    std::size_t tag_bytes_ = 0; ///< used bytes of tags_
    std::vector<TilePoint> line_, piece_;
    TilePoint cursor_{0, 0};
    std::size_t count_ = 0;
};

} // namespace macadam
