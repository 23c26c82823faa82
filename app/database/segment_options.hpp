#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <filesystem>

namespace macadam {

// Operands and options shared by commands that read a database.
inline constexpr Operand store_operand{"STORE",
                                       "The road database, a .gpkg file made by 'macadam init'."};
inline constexpr Option bbox_option =
    in_group("selection",
             {"--bbox",
              "W,S,E,N",
              "Only segments in this box, in degrees; W > E crosses the antimeridian."});
inline constexpr Option way_option =
    in_group("selection", {"--way", "ID", "Only segments of this way."});
inline constexpr Option road_option =
    formerly("--name",
             in_group("selection",
                      {"--road",
                       "TEXT",
                       "Only roads whose name contains this text; upper and lower case are the "
                       "same."}));
inline constexpr Option all_option =
    in_group("selection", {"--all", "", "Also segments without any pass."});

/// Returns the STORE operand.
/// \throws UsageError  for the address of a server: a database is a file.
std::filesystem::path store_file(const Arguments& arguments);

/// Converts degrees W,S,E,N to a box. If W > E it crosses the antimeridian, and its east lies
/// beyond 180 degrees.
/// \throws UsageError  if they form no box.
GeoBox box_of(const std::vector<double>& degrees);

inline constexpr Option highway_option = in_group(
    "selection",
    {"--highway", "CLASS", "Only roads of this OpenStreetMap class, such as residential."});
inline constexpr Option class_option = in_group(
    "selection", {"--class", "NAME", "Only segments in this roughness class, such as poor."});
inline constexpr Option min_passes_option =
    in_group("selection", {"--min-passes", "N", "Only segments with at least this many passes."});

/// Parses --segment.
/// \throws UsageError  for an invalid key.
std::optional<SegmentKey> parse_key(const Arguments& arguments);

/// Checks the class of roads of a filter.
/// \throws UsageError  if it is no class of OSM for cars, and no road of the database has it.
void expect_known_highway(const SegmentFilter& filter, const StoreReader& store);

/// Checks the class name of a filter.
/// \throws UsageError  if the database's class table has no such class.
void expect_known_class(const SegmentFilter& filter, const StoreReader& store);

/// Says that an import is running, or warns if one was interrupted before its passes were fused.
void warn_of_waiting(const StoreReader& store,
                     const std::filesystem::path& file,
                     const Console& console);

} // namespace macadam
