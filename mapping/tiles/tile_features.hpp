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

/// A place on the web's map in whole units, 2^32 of them across the world (0.9 cm at the equator):
/// x from the antimeridian eastwards, y from 85.0511 degrees north southwards.
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
/// \param line  at least one point.
WorldBox box_of(std::span<const WorldPoint> line);

/// The tile of that zoom that holds a place.
TileId tile_at(const WorldPoint& point, int zoom);

/// Texts that many roads share, numbered. 0 is "".
class TileWords {
public:
    TileWords() { number_in_table(""); }
    std::uint32_t number_of(std::string_view word);
    std::string_view word(std::uint32_t number) const { return words_[number]; }

private:
    std::uint32_t number_in_table(std::string_view word);

    std::deque<std::string> words_; ///< which stay where they are
    std::unordered_map<std::string_view, std::uint32_t> numbers_;
    std::array<std::uint32_t, 2> recent_{}; ///< a segment's name and class, as its neighbours have
};

/// A segment with a state, as tiles show it.
struct TileSegment {
    SegmentState state;
    std::uint32_t name; ///< of TileWords
    std::uint32_t highway;
    double from_m;
    double to_m;
    std::vector<WorldPoint> line; ///< in driving direction, at least one point
};

/// \param record  with a state.
TileSegment tile_segment(const SegmentRecord& record, TileWords& words);

/// The place by which a segment belongs to one tile of each zoom: half-way between both ends of its
/// line. It is the same for both directions.
WorldPoint middle_of(const TileSegment& segment);

/// Neighbouring segments of a road as one line, with what they say together.
struct RoadPart {
    SegmentKey first;   ///< the first of its segments in the order of keys
    std::uint32_t name; ///< of TileWords
    std::uint32_t highway;
    bool is_directed; ///< of one direction, in which its line runs; else of both, the worse shown
    std::uint8_t validity;                    ///< flags that hold for all of it
    std::int64_t weight_mm;                   ///< of the mean: length along the road
    std::int64_t um_mm;                       ///< sum of IRI (um/m) times length
    IriUm worst_um;                           ///< of one segment
    std::int32_t passes;                      ///< the least
    std::optional<std::int64_t> last_seen_ms; ///< the latest
    std::vector<std::int64_t>
        class_mm; ///< length in each class of the table, each direction counted
    std::vector<WorldPoint> line;
};

/// Weighted by length, mm/m.
double iri_of(const RoadPart& part);
std::size_t class_of(const RoadPart& part, const ClassTable& table);

/// Length in all classes.
std::int64_t length_mm(const RoadPart& part);

/// What another part says, too. The line stays.
void add_values(RoadPart& part, const RoadPart& other);

/// Each segment as a part of its own.
std::vector<RoadPart> parts_of(std::span<const TileSegment> segments, const ClassTable& table);

/// The same where both directions of a piece of road are one part, laid along its way, that shows
/// the rougher of both; `class_mm` has both. \param segments  in the order of keys.
std::vector<RoadPart> parts_of_both_ways(std::span<const TileSegment> segments,
                                         const ClassTable& table);

} // namespace macadam
