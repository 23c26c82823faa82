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

/// One property of a segment as every output names it, in the order of docs/reference/exports.md.
struct Field {
    enum class Type { text, integer, real };
    std::string_view name;
    Type type;
    int decimals; ///< of a real
};
std::span<const Field> segment_fields();

/// Whether a field of type text says a time, as ISO 8601 in UTC.
bool is_day(const Field& field);

/// The value of each of segment_fields() as text; nothing: not known.
std::vector<std::optional<std::string>> field_values(const SegmentRecord& record,
                                                     const ClassTable& classes);

/// One GeoJSON Feature on one line (RFC 7946: longitude first, 7 decimals; `id` = segment). A line
/// over the antimeridian is a MultiLineString that is cut there.
std::string geojson_feature(const SegmentRecord& record, const ClassTable& classes);

/// A line as the `geometry` of a Feature, in the same way.
std::string geojson_geometry(const std::vector<GeoPoint>& line);

/// A CSV row of the field values and of the middle of the segment (lat_deg, lon_deg), without the
/// line's end. Quoted where RFC 4180 needs it, and where text begins as a formula would (= + - @),
/// which gets an apostrophe before it.
std::string csv_row(const SegmentRecord& record, const ClassTable& classes);
std::string csv_header();

/// Text as a CSV cell, quoted where it must be, as in csv_row.
std::string csv_text(std::string_view text);

/// Writes segments to a file in the order of visit(); its kind is its suffix: .geojson, .geojsonl,
/// .csv, .gpkg (the layer `roughness` with its style, without passes, trips or vehicles), .fgb
/// (FlatGeobuf, in the order of its spatial index), .shp (Shapefile: with its .shx, .dbf, .prj and
/// .cpg), .kml. The file, or the files of a set, appear when they are whole, or not at all.
/// \returns how many segments were written.
///
/// \throws InputError  for a suffix that is not known, for more segments than the kind can hold, or
///                     if the file cannot be written.
std::size_t export_segments(const RoadStore& store,
                            const SegmentFilter& filter,
                            const std::filesystem::path& file,
                            const Progress& progress = {});

/// Suffixes that export_segments knows.
std::span<const std::string_view> export_suffixes();

} // namespace macadam
