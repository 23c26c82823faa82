#pragma once

#include "storage/atomic/atomic_file.hpp"
#include "storage/exports/export.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>

namespace macadam {

// The writers behind export_segments, one for each kind of file.

struct SegmentExport {
    const RoadStore& store;
    const SegmentFilter& filter;
    const std::filesystem::path& file; ///< as the user named it
    const Progress& progress;
    const ClassTable& classes; ///< the store's
};

/// Visits, counts and tells how far it is. \returns how many.
///
/// \throws InputError  when a stop is wanted, so that no half file takes its place.
std::size_t each_segment(const SegmentExport& what,
                         const std::function<void(const SegmentRecord&)>& write);

/// "Roughness (IRI, mm/m)." and whose roads they are.
std::string description_of(const SegmentExport& what);

std::size_t export_geopackage(const SegmentExport& what);
std::size_t write_kml(const SegmentExport& what, AtomicFile& file);

/// These two let GDAL write, in a folder beside the place.
std::size_t export_flatgeobuf(const SegmentExport& what);
std::size_t export_shapefile(const SegmentExport& what);

} // namespace macadam
