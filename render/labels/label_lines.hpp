#pragma once

#include "render/labels/label_placement.hpp"

namespace macadam {

/// A road's part in a cell, in pixels from the cell's corner, in an order and direction of its own:
/// the same for the same geometry, however it was given.
struct NamedPart {
    std::vector<PixelPoint> line;
    std::string name;
    int rank = 0;
    bool quiet = false;
    double half_width_px = 0;
};

/// The parts of roads in a cell, each once: two directions of a road are one.
std::vector<NamedPart> parts_in(std::span<const RoadName> roads, const PixelBox& cell);

/// Parts of one name that follow each other end to end, as one line each; where more than two meet
/// the straightest pairs go on, and nothing turns by more than 60 degrees. Parts without a name are
/// left out.
///
/// \param parts  as parts_in gives them
std::vector<NamedPart> named_chains(const std::vector<NamedPart>& parts);

double length_px(std::span<const PixelPoint> line);

} // namespace macadam
