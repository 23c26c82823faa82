#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "storage/store/road_store.hpp"

#include <filesystem>

namespace macadam {

// What commands that read a store have in common.
inline constexpr Operand store_operand{"STORE",
                                       "The road database, a .gpkg file made by 'macadam init'."};
inline constexpr Option bbox_option{"--bbox", "W,S,E,N", "Only segments in this box, in degrees."};
inline constexpr Option way_option{"--way", "ID", "Only segments of this way."};
inline constexpr Option name_option{
    "--name",
    "TEXT",
    "Only roads whose name contains this text; upper and lower case are the "
    "same."};
inline constexpr Option all_option{"--all", "", "Also segments without any pass."};

/// The STORE operand. \throws UsageError for the address of a server: a store is a file.
std::filesystem::path store_file(const Arguments& arguments);

/// A box from degrees W,S,E,N. \throws UsageError if it is not one.
GeoBox box_of(const std::vector<double>& degrees);

inline constexpr Option highway_option{
    "--highway", "CLASS", "Only roads of this OpenStreetMap class, such as residential."};
inline constexpr Option class_option{
    "--class", "NAME", "Only segments in this roughness class, such as poor."};
inline constexpr Option min_passes_option{
    "--min-passes", "N", "Only segments with at least this many passes."};

/// Of --bbox, --way, --name, --highway, --class, --min-passes, --since, --until and --all.
/// \throws UsageError for values that do not fit.
SegmentFilter parse_filter(const Arguments& arguments);

/// Of --segment. \throws UsageError  for what is no key.
std::optional<SegmentKey> parse_key(const Arguments& arguments);

/// \throws UsageError  if the store's class table has no class of the filter's name.
void expect_known_class(const SegmentFilter& filter, const RoadStore& store);

/// Says so if an import was cut off before its passes were fused.
void warn_of_waiting(const RoadStore& store,
                     const std::filesystem::path& file,
                     const Console& console);

} // namespace macadam
