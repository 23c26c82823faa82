#pragma once

#include "app/cli/console.hpp"
#include "app/import/import_trips.hpp"
#include "estimator/common/geo.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace macadam {

/// Describes the trips outside a map in one sentence: "none of 6 trips touches this map: trips near
/// 47.69, 17.67; map covers ...". Positions are rounded, because they show where people drive: to
/// 0.01 degrees (1 km), those of cars of others to 0.1 degrees.
///
/// \param outside    middle of each such trip; not empty
/// \param looked_at  number of all trips
std::string outside_text(std::span<const GeoPoint> outside,
                         std::size_t looked_at,
                         const GeoBox& map,
                         PrivacyProfile privacy);

/// Warns of trips that were imported before with other settings, in one line.
///
/// \param path  what was imported, for the command that applies the settings
void warn_of_earlier_settings(const ImportTotals& totals,
                              const std::filesystem::path& store,
                              const std::filesystem::path& path,
                              const Console& console);

/// Warns in one line of trips outside the map, unless all are.
///
/// \throws InputError  in the same words, if all are.
void expect_on_map(const ImportTotals& totals, const StoreReader& store, const Console& console);

} // namespace macadam
