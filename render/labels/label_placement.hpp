#pragma once

#include "render/projection/projection.hpp"
#include "render/text/text_shaping.hpp"

#include <span>
#include <string>
#include <vector>

namespace macadam {

/// Interval of a road on the plane in which labels are placed: pixels of the whole world at one
/// zoom (x from the antimeridian, y from the north, as `tile_position` times the size of a tile),
/// or of one picture. Intervals of one road share bit-identical end points.
struct RoadName {
    std::vector<PixelPoint> line;
    std::string name;         ///< "": no label, but other labels avoid the line
    int rank = 0;             ///< 0 motorway .. 5 service: priority of the label
    bool quiet = false;       ///< road without a measurement: placed last, in lighter ink
    double half_width_px = 0; ///< of the road as painted
};

/// Part of the plane with independent labels: every label lies completely inside one cell and
/// depends only on the roads in it. The labels of a cell are therefore the same in every request.
struct LabelCell {
    PixelBox box;                    ///< corners in whole pixels
    std::vector<PixelBox> kept_free; ///< areas without labels: the legend
};

struct LabelConfig {
    double size_px = 12;       ///< of the em; slightly larger for main roads
    double halo_px = 2;        ///< around letters, in the colour of the ground
    double gap_px = 1;         ///< between letters' halo and road
    double repeat_px = 320;    ///< spacing of labels of the same name along a road
    double max_bend_deg = 18;  ///< from one letter to the next
    double max_turn_deg = 30;  ///< of a letter from the label's direction
    double max_covered = 0.15; ///< share of a label's area that may be road
};

/// Glyph with its position in the cell.
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

/// Returns the cell of the world's grid that contains a pixel of the world.
LabelCell label_cell_at(double x_px, double y_px);

/// Places the names of the roads in a cell: along them, beside the line (which stays visible),
/// never upside down, where the road is straight enough for the letters; repeated along long roads,
/// apart from each other, and covering other roads by at most max_covered. Main roads have
/// priority, then longer ones. A name without fonts for all of its characters has no label.
///
/// The result depends only on the roads' parts in the cell, to the last bit: the order of `roads`,
/// their directions, their course outside the cell and duplicates have no effect. A road that is
/// shorter than its label in every cell has no label.
///
/// \throws InputError  if the font of a script is not installed.
std::vector<Label> placed_labels(std::span<const RoadName> roads,
                                 const LabelCell& cell,
                                 const LabelConfig& config,
                                 TypeSetter& setter);

} // namespace macadam
