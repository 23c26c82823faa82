#pragma once

#include "render/map/map_insets.hpp"
#include "render/scene/scene.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <vector>

namespace macadam {

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
/// filter selects, with the names of places in them.
void set_details(const StoreReader& store,
                 const SegmentFilter& filter,
                 const DetailRoom& room,
                 MapScene& scene);

} // namespace macadam
