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
inline constexpr int tile_buffer = 64;   ///< units around it that lines are drawn into: 4 px of 256

/// The world units that a tile shows with its buffer.
WorldBox shown_by(const TileId& tile);
bool meet(const WorldBox& a, const WorldBox& b);

/// One layer of lines of a Mapbox Vector Tile, version 2.1. Features are written one after the
/// other: begin(), their properties, end(). Values that are alike are stored once.
///
/// Source: Mapbox Vector Tile Specification, version 2.1, 4.
class VectorLayer {
public:
    /// \param tile  of zoom 0 to 20.
    /// \param keys  names of the properties; they are known by their places here.
    VectorLayer(std::string_view name, const TileId& tile, std::span<const std::string_view> keys);

    /// The line as the tile shows it, cut off at its buffer, on the tile's units. One that is
    /// smaller than a unit is drawn one unit long. \returns false, and begins nothing, if the line
    /// is not there. \param line  at least one point.
    bool begin(std::span<const WorldPoint> line);

    void add(std::uint32_t key, std::string_view text);
    void add(std::uint32_t key, std::int64_t whole);
    void add_real(std::uint32_t key,
                  double value); ///< round it before: alike is what has all bits alike
    void add_unlike(std::uint32_t key, std::string_view text); ///< that no other feature has

    void end(std::optional<std::uint64_t> id);

    std::size_t count() const { return count_; } ///< of features
    std::string tile_bytes() const;              ///< a tile with this layer alone, not compressed

private:
    struct Value {
        enum class Kind : std::uint8_t {
            text,
            whole,
            real,
            unlike
        } kind;                 ///< unlike: a text that is not looked up
        std::uint64_t bits;     ///< of a number; of a text its hash
        std::uint32_t at, size; ///< in values_
    };
    struct Slot {
        std::uint32_t number; ///< of a value, plus 1; 0 is free
        std::uint32_t hash;   ///< what the place of the slot does not tell of it
    };
    struct Place {
        std::int32_t x, y;
        friend bool operator==(const Place&, const Place&) = default;
    };

    Place place_of(const WorldPoint& point) const;
    void put_line(std::span<const Place> line);
    static bool lies_within(const Place& place);
    void put_clipped(const Place& from, const Place& to);
    void go_on(const Place& begin, const Place& end);
    void move_to(const Place& place);
    void line_to(const Place& place);
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
    std::string features_;      ///< encoded, one after the other
    std::string values_;        ///< likewise
    std::vector<Value> known_;
    std::vector<Slot> slots_;             ///< by hash
    std::vector<std::uint32_t> last_;     ///< by key: the value that it had last, plus 1
    std::vector<std::uint32_t> geometry_; ///< of the feature that is begun
    std::vector<char> tags_;              ///< likewise, encoded, with room for every key once
    std::size_t tag_bytes_ = 0;           ///< of them
    std::vector<Place> line_, piece_;
    Place cursor_{0, 0};
    std::size_t count_ = 0;
};

} // namespace macadam
