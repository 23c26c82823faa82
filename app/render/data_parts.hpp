#pragma once

#include "render/map/sheet/map_insets.hpp"
#include "render/scene/scene.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <string>
#include <vector>

namespace macadam {

/// Returns the box that a map of data shows: with a margin, and ground beside a single road.
GeoBox box_with_margin(const GeoBox& box);

/// Returns the name of the most important place in a box, or "".
std::string place_in(const StoreReader& store, const GeoBox& box);

/// Gives up to three parts of the selected segments insets if they lie so far off the longest part
/// that this is shown at two and a half times the scale or more; the scene's box becomes that of
/// the longest part.
void set_insets(const StoreReader& store, const SegmentFilter& filter, MapScene& scene);

/// A measured length at its middle on the ground.
struct MeasuredLength {
    GeoPoint at;
    double length_m;
};

/// Returns the areas with most measured length in order for reading. They hardly overlap; an area
/// with less than a third of the greatest length is left out.
///
/// \param box  of the map, in which the areas lie
std::vector<GeoBox> densest_areas(const std::vector<MeasuredLength>& measured,
                                  const GeoBox& box,
                                  const DetailRoom& room);

/// Adds the details that a sheet has room for to its scene: areas with most measured roads that a
/// filter selects, with the names of places in them. Where the map names all roads already, an area
/// with a single one is left out: a detail would tell nothing new.
void set_details(const StoreReader& store,
                 const SegmentFilter& filter,
                 const DetailRoom& room,
                 MapScene& scene);

/// Moves the scene's box to the area of a sheet with most measured roads, unless the data fits the
/// sheet.
///
/// \param room  the sheet's map
/// \returns whether it moved the box
bool centre_on_densest_area(const StoreReader& store,
                            const SegmentFilter& filter,
                            const DetailRoom& room,
                            MapScene& scene);

} // namespace macadam
