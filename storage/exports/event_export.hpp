#pragma once

#include "storage/exports/text_export.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/text/columns.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace macadam {

/// Columns of fused events for every format, in the order of docs/reference/exports.md.
const Columns<EventRecord>& event_fields();

/// Formats a Feature with the geometry of a point, as geojson_feature() does (export.hpp).
std::string geojson_feature(const GeoPoint& at, const JsonObject& properties);

/// Formats an event as a GeoJSON Feature on one line.
std::string geojson_feature(const EventRecord& record);

/// Writes the events of a filter to a file as points, in the order of StoreReader::events(). The
/// suffix selects the format: .geojson, .geojsonl, .csv, .gpkg (layer `events`), .kml. The file
/// appears complete or not at all. \returns the number of events written.
///
/// \throws InputError  for an unknown suffix, or if the file cannot be written.
std::size_t export_events(const StoreReader& store,
                          const SegmentFilter& filter,
                          const std::filesystem::path& file,
                          const TextExport& text = {});

/// Suffixes supported by export_events.
std::span<const std::string_view> event_export_suffixes();

} // namespace macadam
