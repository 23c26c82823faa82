#pragma once

#include "storage/store/records/privacy_profile.hpp"

#include <string>

namespace macadam {

/// Returns the SQL that creates all tables of an empty road database (docs/reference/database.md).
std::string store_tables();

/// Column that version 7 added to table trip.
inline constexpr const char* trimmed_column = "trimmed_mm INTEGER NOT NULL DEFAULT 0";

/// Returns the SQL that creates view `roughness`, which QGIS shows as a layer: all fused values, or
/// those of the latest publication of a crowd database.
std::string roughness_layer(PrivacyProfile privacy);

} // namespace macadam
