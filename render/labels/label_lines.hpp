#pragma once

#include "render/labels/label_placement.hpp"

namespace macadam {

/// Part of a road in a cell, in pixels from the cell's corner, with a canonical order and
/// direction: the same for the same geometry, regardless of the input.
struct NamedPart {
    std::vector<PixelPoint> line;
    std::string name;
    int rank = 0;
    bool quiet = false;
    double half_width_px = 0;
};

/// Returns the parts of roads in a cell without duplicates; the two directions of a road count as
/// one.
std::vector<NamedPart> parts_in(std::span<const RoadName> roads, const PixelBox& cell);

/// Joins parts of the same name end to end to lines. Where more than two parts meet, the
/// straightest pairs are joined; turns are limited to 60 degrees. Parts without a name are omitted.
///
/// \param parts  as returned by parts_in
std::vector<NamedPart> named_chains(const std::vector<NamedPart>& parts);

/// Area in which roads meet.
struct JunctionCore {
    PixelPoint middle;
    double radius_px; ///< half the width of its widest road
};

/// Returns the positions at which three or more parts end.
///
/// \param parts  as returned by parts_in
std::vector<JunctionCore> junction_cores(std::span<const NamedPart> parts);

double length_px(std::span<const PixelPoint> line);

} // namespace macadam
