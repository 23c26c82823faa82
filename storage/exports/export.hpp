#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/store/road_store.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Property of a segment as named in every export, in the order of docs/reference/exports.md.
struct Field {
    enum class Type { text, integer, real };
    std::string_view name;
    Type type;
    int decimals; ///< of a real number
};
std::span<const Field> segment_fields();

/// Tests whether a text field holds a time, as ISO 8601 in UTC.
bool is_day(const Field& field);

/// Value of each of segment_fields() as text; `std::nullopt` if unknown.
std::vector<std::optional<std::string>> field_values(const SegmentRecord& record,
                                                     const ClassTable& classes);

/// Formats a segment as a GeoJSON Feature on one line (RFC 7946: longitude first, 7 decimals; `id`
/// = segment). A line across the antimeridian becomes a MultiLineString that is cut there.
std::string geojson_feature(const SegmentRecord& record, const ClassTable& classes);

/// Formats a line as the `geometry` of a Feature, in the same way.
std::string geojson_geometry(const std::vector<GeoPoint>& line);

/// Formats a CSV row without line end: the field values and the midpoint of the segment (lat_deg,
/// lon_deg). Cells are quoted where RFC 4180 requires it; text that begins like a formula (= + - @)
/// is also quoted and prefixed with an apostrophe.
std::string csv_row(const SegmentRecord& record, const ClassTable& classes);
std::string csv_header();

/// Formats text as a CSV cell, quoted as in csv_row.
std::string csv_text(std::string_view text);

/// Writes segments to a file in the order of visit(). The suffix selects the format: .geojson,
/// .geojsonl, .csv, .gpkg (layer `roughness` with its style, without passes, trips or vehicles),
/// .fgb (FlatGeobuf, in the order of its spatial index), .shp (Shapefile with .shx, .dbf, .prj and
/// .cpg), .kml. The file, or the set of files, appears complete or not at all.
/// \returns the number of segments written.
///
/// \throws InputError  for an unknown suffix, for more segments than the format can hold, or if the
///                     file cannot be written.
std::size_t export_segments(const RoadStore& store,
                            const SegmentFilter& filter,
                            const std::filesystem::path& file,
                            const Progress& progress = {});

/// Suffixes supported by export_segments.
std::span<const std::string_view> export_suffixes();

} // namespace macadam
