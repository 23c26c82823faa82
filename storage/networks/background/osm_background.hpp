#pragma once

#include "estimator/common/geo.hpp"
#include "estimator/common/progress.hpp"
#include "mapping/background/background.hpp"

#include <cstddef>
#include <filesystem>

namespace macadam {

/// Objects of an OSM file that were left out of its background.
struct LeftOutAreas {
    std::size_t not_closed = 0;    ///< rings open or crossing, or nodes missing, as at a border
    std::size_t too_long = 0;      ///< more points than real areas have
    bool has_broken_coast = false; ///< its coastlines enclose no sea, of which it has none
};

/// Reads what lies below and beside the roads of an OSM file: water, sea, green, built-up land,
/// buildings, railways, names of places, numbers of roads. Only what meets `box` is given to the
/// sink, areas by way of libosmium's assembler of multipolygons, the sea by assemble_sea.
///
/// Memory is bounded by some 16 million points of ways, 8 million of coastlines, and the ways of
/// the multipolygons, whatever the size of the file, which is read repeatedly: three times if it is
/// that of a small country.
///
/// \param max_points  of ways held at a time; at least one way is
/// \throws InputError  if the file is damaged, or if it is stopped.
LeftOutAreas read_osm_background(const std::filesystem::path& file,
                                 const GeoBox& box,
                                 const BackgroundSink& sink,
                                 const Progress& progress,
                                 std::size_t max_points = 16'000'000);

} // namespace macadam
