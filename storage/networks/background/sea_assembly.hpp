#pragma once

#include "estimator/common/geo.hpp"
#include "storage/networks/background/area_assembly.hpp"

#include <span>
#include <vector>

namespace macadam {

/// Sea of an extract of OpenStreetMap.
struct Sea {
    /// Outer ring, then the islands in it, without repeated points.
    std::vector<std::vector<std::vector<PackedPoint>>> areas{};
    bool is_broken =
        false; ///< coastlines end in the middle of the extract or contradict each other
};

/// Assembles the sea from the coastlines of an extract. By OpenStreetMap's convention, land lies on
/// the left of a coastline and the sea on its right.
///
/// Within the extract's bounds the coastlines and parts of the border make up its rings. A coast
/// that ends up to a quarter of the width inside of the bounds, as where an extract follows a
/// country's border, makes them narrower. Beyond the bounds the sea goes on as at their edge
/// where it takes a quarter of a side or more; narrower water, as of a harbour, ends there.
///
/// \param coast   ways with natural=coastline, in any order, each in its own direction; points that
///                the file lacks, NodePositions::nowhere, are gaps
/// \param bounds  of the extract
/// \param room    area for which the sea is wanted
/// \returns no areas if there is no coast or it is broken.
Sea assemble_sea(std::span<const PlacedWay> coast, const GeoBox& bounds, const GeoBox& room);

} // namespace macadam
