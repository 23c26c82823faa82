#pragma once

#include "storage/exports/export.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>

namespace macadam {

// Writers behind export_segments, one per format.

struct SegmentExport {
    const StoreReader& store;
    const SegmentFilter& filter;
    const std::filesystem::path& file; ///< as named by the user
    const Progress& progress;
    const ClassTable& classes; ///< of the database
    UnitSystem units;
    Columns<ClassedSegment> columns;    ///< in these units
    Columns<ClassedSegment> attributes; ///< those that are attributes in files of other programs
};

/// Visits the segments and reports progress. \returns the number of segments.
///
/// \throws InputError  if a stop is requested, so that no partial file is committed.
std::size_t each_segment(const SegmentExport& what,
                         const std::function<void(const SegmentRecord&)>& write);

/// "Roughness (IRI, mm/m)." or in/mi, and the attribution of the roads.
std::string description_of(const SegmentExport& what);

std::size_t export_geopackage(const SegmentExport& what);
std::size_t write_kml(const SegmentExport& what, const PutText& put);

/// Written by GDAL, in a folder beside the output file.
std::size_t export_flatgeobuf(const SegmentExport& what);
std::size_t export_shapefile(const SegmentExport& what);

} // namespace macadam
