#pragma once

#include "render/projection/projection.hpp"
#include "render/text/text_shaping.hpp"

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Interval of a road on the plane in which labels are placed: pixels of the whole world at one
/// zoom (x from the antimeridian, y from the north, as `tile_position` times the size of a tile),
/// or of one picture. Intervals of one road share bit-identical end points.
struct RoadName {
    std::vector<PixelPoint> line;
    std::string name;         ///< "": no label, but other labels avoid the line
    std::string number{};     ///< of the road, for shields beside those of names that are numbers
    int rank = 0;             ///< 0 motorway .. 5 service: priority of the label
    bool quiet = false;       ///< road without a measurement: placed last, in lighter ink
    double half_width_px = 0; ///< of the road as painted
};

/// Place to be named, on the plane of the labels.
struct PointName {
    PixelPoint at;
    std::string name;
    TextLook look;
    double symbol_px = 0;           ///< radius of its symbol, beside which the name stands; 0: none
    bool may_cover_measured = true; ///< measured roads, if no position is free of them
};

/// Part of the plane with independent labels: every label lies completely inside one cell and
/// depends only on the roads in it. The labels of a cell are therefore the same in every request.
struct LabelCell {
    PixelBox box;                    ///< corners in whole pixels
    std::vector<PixelBox> kept_free; ///< areas without labels: the legend
};

struct LabelConfig {
    double size_px = 12;       ///< of the em; larger for main roads, smaller for others
    double min_size_px = 10;   ///< for all roads
    double halo_px = 2;        ///< around letters, in the colour of the ground
    double gap_px = 1;         ///< between letters' halo and road
    double repeat_px = 320;    ///< spacing of labels of the same name along a road
    double max_bend_deg = 18;  ///< from one letter to the next
    double max_turn_deg = 30;  ///< of a letter from the label's direction
    double max_covered = 0.15; ///< share of a label's area that may be road
    double min_core_px = 0;    ///< smallest radius of a junction's core that is kept free
    bool moves_others = false; ///< a label without room may move others aside
};

/// Corners of a letter's area, in order around it.
using LabelQuad = std::array<PixelPoint, 4>;

/// Glyph with its position in the cell.
struct LabelGlyph {
    SetGlyph glyph;
    GlyphPose pose; ///< in pixels from the corner of the cell
};

struct Label {
    std::string name;
    TextLook look;
    bool quiet = false;
    bool is_shield = false; ///< the number of a road, in a frame as large as `box`
    double halo_px = 0;
    int left = 0, top = 0; ///< corner of the cell on the plane, whole pixels
    std::vector<LabelGlyph> glyphs;
    PixelBox box;                     ///< on the plane, halo included
    std::vector<LabelQuad> letters{}; ///< on the plane, from descenders to capitals
};

/// Side of the cells of tiles, in pixels: a multiple of the size of a tile, so that no tile needs
/// more than one cell.
inline constexpr int label_cell_px = 512;

/// Returns the cell of the world's grid that contains a pixel of the world.
LabelCell label_cell_at(double x_px, double y_px);

/// Tells whether a road's name is its number, such as "A 9", "B191" or "73": it gets a shield.
bool is_road_number(std::string_view name);

/// Places names in a cell, the important ones first: places; numbers of roads, upright in frames on
/// them; then main roads and longer ones before others.
///
/// * The name of a place is centred on it, or stands in one of eight positions around it, close to
///   it or farther away, the best of which is to its upper right: where it covers no measured road,
///   if there is such a position, and the fewest others.
/// * The name of a road runs along it and across its junctions, as far as roads of the same name
///   continue each other: beside the line (which stays visible), never upside down, where the road
///   is straight enough for the letters, off the middles of junctions. It is repeated along long
///   roads, apart from itself, and covers other roads by at most max_covered.
/// * If no position is free, a label may move up to two others to positions that are free for them
///   (`moves_others`).
///
/// A name without fonts for all of its characters has no label.
///
/// The result depends only on the roads' parts in the cell, to the last bit: the order of `roads`,
/// their directions, their course outside the cell and duplicates have no effect. A road that is
/// shorter than its label in every cell has no label.
///
/// Sources: E. Imhof, "Positioning names on maps", The American Cartographer 2 (1975), pp. 128-144;
/// J. Christensen, J. Marks, S. Shieber, "An empirical study of algorithms for point-feature label
/// placement", ACM Transactions on Graphics 14 (1995), pp. 203-232: positions around a point (fig.
/// 2) and the gain of moving labels over placing them once; R. C. Thomson, D. E. Richardson, "The
/// good continuation principle of perceptual organization applied to the generalization of road
/// networks", Proc. 19th ICC (1999): strokes.
///
/// \param places  the important ones first
/// \throws InputError  if the font of a script is not installed.
std::vector<Label> placed_labels(std::span<const RoadName> roads,
                                 std::span<const PointName> places,
                                 const LabelCell& cell,
                                 const LabelConfig& config,
                                 TypeSetter& setter);

} // namespace macadam
