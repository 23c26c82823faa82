#pragma once

#include "mapping/fusion/segment_record.hpp"
#include "mapping/style/iri_class.hpp"
#include "mapping/tiles/tile_grid.hpp"

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace macadam {

/// A position in Web Mercator in whole units, 2^32 of them across the world (0.9 cm at the
/// equator): x from the antimeridian eastwards, y from 85.0511 degrees north southwards.
struct WorldPoint {
    std::uint32_t x;
    std::uint32_t y;
    friend auto operator<=>(const WorldPoint&, const WorldPoint&) = default;
};
inline constexpr int world_bits = 32;

WorldPoint world_point(const GeoPoint& point);

/// Inclusive on all sides.
struct WorldBox {
    std::uint32_t min_x, min_y;
    std::uint32_t max_x, max_y;
};
/// Returns the bounding box.
///
/// \param line  at least one point.
WorldBox box_of(std::span<const WorldPoint> line);

/// Returns the tile of a zoom that contains a position.
TileId tile_at(const WorldPoint& point, int zoom);

/// Interned strings shared by many roads. Number 0 is "".
class TileWords {
public:
    TileWords() { number_in_table(""); }
    std::uint32_t number_of(std::string_view word);
    std::string_view word(std::uint32_t number) const { return words_[number]; }

private:
    std::uint32_t number_in_table(std::string_view word);

    std::deque<std::string> words_; ///< a deque, so that references stay valid
    std::unordered_map<std::string_view, std::uint32_t> numbers_;
    std::array<std::uint32_t, 2>
        recent_{}; ///< name and class of the last segment, which neighbours often share
};

/// A segment with a state, prepared for tiles.
struct TileSegment {
    SegmentState state;
    std::uint32_t name; ///< number in TileWords, as is highway
    std::uint32_t highway;
    double from_m;
    double to_m;
    std::vector<WorldPoint> line; ///< in driving direction, at least one point
};

/// Prepares a segment for tiles.
///
/// \param record  with a state.
TileSegment tile_segment(const SegmentRecord& record, TileWords& words);

/// Returns the point that assigns a segment to one tile of each zoom: half-way between both ends of
/// its line, the same for both directions.
WorldPoint middle_of(const TileSegment& segment);

/// Neighbouring segments of a road as one line with combined values.
struct RoadPart {
    SegmentKey first;   ///< lowest of its segment keys
    std::uint32_t name; ///< number in TileWords, as is highway
    std::uint32_t highway;
    bool is_directed;      ///< one direction, that of its line; otherwise both, showing the rougher
    std::uint8_t validity; ///< flags that hold for the entire part
    std::int64_t weight_mm;                   ///< weight of the mean: length along the road
    std::int64_t um_mm;                       ///< sum of IRI (um/m) times length
    IriUm worst_um;                           ///< of a single segment
    std::int32_t passes;                      ///< minimum
    std::optional<std::int64_t> last_seen_ms; ///< latest
    std::vector<std::int64_t>
        class_mm; ///< length in each class of the table, counting each direction
    std::vector<WorldPoint> line;
};

/// Returns the length-weighted mean IRI, mm/m.
double iri_of(const RoadPart& part);
std::size_t class_of(const RoadPart& part, const ClassTable& table);

/// Returns the total length of all classes.
std::int64_t length_mm(const RoadPart& part);

/// Adds the values of another part, leaving the line unchanged.
void add_values(RoadPart& part, const RoadPart& other);

/// Converts each segment to a part.
std::vector<RoadPart> parts_of(std::span<const TileSegment> segments, const ClassTable& table);

/// Converts segments to parts in which both directions of a road are one part along its way,
/// showing the rougher direction; `class_mm` covers both. \param segments  in key order.
std::vector<RoadPart> parts_of_both_ways(std::span<const TileSegment> segments,
                                         const ClassTable& table);

} // namespace macadam
