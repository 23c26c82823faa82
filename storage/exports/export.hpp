#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/exports/text_export.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Segment as a row of output.
struct ClassedSegment {
    const SegmentRecord& record;
    const ClassTable& classes;
};

/// Columns of segments for every format, in the order of docs/reference/exports.md.
const Columns<ClassedSegment>& segment_columns();

/// Those columns that are properties or attributes in files of other programs.
const Columns<ClassedSegment>& segment_attributes();

/// Value of each attribute as text; `std::nullopt` if unknown.
/// \param attributes  segment_attributes(), in any units
std::vector<std::optional<std::string>>
attribute_texts(const ClassedSegment& segment,
                const Columns<ClassedSegment>& attributes = segment_attributes());

/// Formats a segment as a GeoJSON Feature on one line (RFC 7946: longitude first, 7 decimals; `id`
/// = segment). A line across the antimeridian becomes a MultiLineString that is cut there.
/// \param columns  segment_columns(), in any units
std::string geojson_feature(const ClassedSegment& segment,
                            const Columns<ClassedSegment>& columns = segment_columns());

/// Formats a Feature in the same way.
/// \param line  empty: the geometry is null
std::string geojson_feature(const std::optional<JsonValue>& id,
                            const std::vector<GeoPoint>& line,
                            const JsonObject& properties);

/// Appends a line as the `geometry` of a Feature, in the same way.
void append_geojson_geometry(std::string& text, std::span<const GeoPoint> line);

/// Writes segments to a file in the order of visit(). The suffix selects the format: .geojson,
/// .geojsonl, .csv, .gpkg (layer `roughness` with its style, without passes, trips or vehicles),
/// .fgb (FlatGeobuf, in the order of its spatial index), .shp (Shapefile with .shx, .dbf, .prj and
/// .cpg), .kml. The file, or the set of files, appears complete or not at all.
/// \returns the number of segments written.
///
/// \throws InputError  for an unknown suffix, for more segments than the format can hold, or if the
///                     file cannot be written.
std::size_t export_segments(const StoreReader& store,
                            const SegmentFilter& filter,
                            const std::filesystem::path& file,
                            const Progress& progress = {},
                            const TextExport& text = {});

/// Tests whether a suffix is that of a text file, which TextExport::put takes.
bool is_text_suffix(std::string_view suffix);

/// Suffixes supported by export_segments.
std::span<const std::string_view> export_suffixes();

} // namespace macadam
