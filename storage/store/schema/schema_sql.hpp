#pragma once

#include "storage/store/records/privacy_profile.hpp"

#include <string>

namespace macadam {

/// Returns the SQL that creates all tables of an empty road database (docs/reference/database.md).
std::string store_tables();

/// Returns the SQL that creates view `roughness`, which QGIS shows as a layer: all fused values, or
/// those of the latest publication of a crowd database.
std::string roughness_layer(PrivacyProfile privacy);

} // namespace macadam
