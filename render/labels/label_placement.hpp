#pragma once

#include "render/projection/projection.hpp"
#include "render/text/text_shaping.hpp"

#include <span>
#include <string>
#include <vector>

namespace macadam {

/// A piece of road on the plane that labels are placed in: pixels of the whole world at one zoom
/// (x from the antimeridian, y from the north, as `tile_place` times the size of a tile), or of one
/// picture. Pieces of one road share their end points to the last bit of the number.
struct RoadName {
    std::vector<PixelPoint> line;
    std::string name;         ///< "": no label, but others keep off the line
    int rank = 0;             ///< 0 motorway .. 5 service: who comes first
    bool quiet = false;       ///< a road without a measurement: comes last, in quieter ink
    double half_width_px = 0; ///< of the road as painted
};

/// A part of the plane that is labelled for itself: every label stands wholly inside one cell and
/// only knows the roads in it. So a cell's labels are the same whoever asks for them.
struct LabelCell {
    PixelBox box;                    ///< corners in whole pixels
    std::vector<PixelBox> kept_free; ///< no label here: the legend
};

struct LabelConfig {
    double size_px = 12;       ///< of the em; main roads a little larger
    double halo_px = 2;        ///< around letters, in the colour of the ground
    double gap_px = 1;         ///< between letters' halo and road
    double repeat_px = 320;    ///< along a road, from label to label of the same name
    double max_bend_deg = 18;  ///< from one letter to the next
    double max_turn_deg = 30;  ///< of a letter from the label's direction
    double max_covered = 0.15; ///< of a label's ground that may be road
};

/// A glyph where it stands in its cell.
struct LabelGlyph {
    SetGlyph glyph;
    GlyphPose pose; ///< in pixels from the corner of the cell
};

struct Label {
    std::string name;
    TextLook look;
    bool quiet = false;
    double halo_px = 0;
    int left = 0, top = 0; ///< corner of the cell on the plane, whole pixels
    std::vector<LabelGlyph> glyphs;
    PixelBox box; ///< on the plane, halo included
};

/// Side of the cells of tiles, in pixels: a multiple of the size of a tile, so that no tile needs
/// more than one cell.
inline constexpr int label_cell_px = 512;

/// The cell of the world's grid that a pixel of the world lies in.
LabelCell label_cell_at(double x_px, double y_px);

/// The names of the roads in a cell: along them, beside the line (so that it stays to be seen),
/// never head-down, where the road is straight enough for its letters; repeated along long roads;
/// apart from each other; off other roads as far as max_covered says. Main roads come first, then
/// longer ones. A name that no font can set in full has no label.
///
/// A function of the roads' parts in the cell alone: neither the order of `roads`, nor their
/// directions, nor what they do outside the cell, nor whether one is given twice, changes a bit of
/// the result. A road that has less than its label's length in every cell has none.
///
/// \throws InputError  if the font of a script is not installed.
std::vector<Label> placed_labels(std::span<const RoadName> roads,
                                 const LabelCell& cell,
                                 const LabelConfig& config,
                                 TypeSetter& setter);

} // namespace macadam
