#pragma once

#include "app/cli/arguments.hpp"
#include "app/database/period_options.hpp"
#include "app/database/segment_options.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Options that select segments and passes, the same in `query`, `export`, `render` and `report`.
inline constexpr std::array selection_options{
    bbox_option,
    in_group("selection",
             {"--area",
              "FILE",
              "Only segments in the polygons of this file: GeoJSON, GeoPackage, Shapefile, KML or "
              "another layer."}),
    way_option,
    road_option,
    highway_option,
    class_option,
    min_passes_option,
    in_group("selection",
             {"--min-cars", "N", "Only segments that at least this many cars measured."}),
    in_group("selection",
             {"--vehicle-id", "NAME", "Use only passes of this car; not in a crowd database."}),
    since_option,
    until_option};

/// Parses --bbox, --way, --road, --highway, --since and --until.
/// \throws UsageError  for invalid values.
SegmentFilter parse_road_filter(const Arguments& arguments);

/// Parses the selection, and --all of a command that has it. The file of --area is read.
/// SegmentFilter::vehicle is as given until complete_filter.
/// \throws UsageError  for invalid values.
/// \throws InputError  for an invalid file.
SegmentFilter parse_filter(const Arguments& arguments);

/// Returns the files that a selection reads.
std::vector<std::filesystem::path> files_of_filter(const Arguments& arguments);

/// Checks a filter against a database, and replaces the name of the car by its pseudonym.
/// \throws UsageError  for a class of roads or of roughness that it does not have.
/// \throws InputError  for a car that it does not have, and for any car of a crowd database.
void complete_filter(SegmentFilter& filter, const StoreReader& store);

/// Tests for conditions on segments other than their passes and cars, which apply to single
/// segments only, not to sections of roads.
bool selects_segments(const SegmentFilter& filter);

/// Checks that no option selects single segments where --sections is given: each section is
/// reported with all of its segments.
///
/// \throws UsageError  if there is one.
void expect_whole_sections(const SegmentFilter& filter);

/// Tests for any condition.
bool selects(const SegmentFilter& filter);

/// Returns the selection as options: "--road haupt --min-passes 3"; "" without one. Names of cars
/// are left out, as they stay in the database.
/// \param but  an option to leave out
std::string text_of_filter(const Arguments& arguments, std::string_view but = {});

} // namespace macadam
