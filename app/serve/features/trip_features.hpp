#pragma once

#include "app/serve/features/feature.hpp"
#include "app/serve/features/feature_list.hpp"

#include <filesystem>
#include <vector>

namespace macadam {

/// Columns of trips: car, day, lengths and counts.
const std::vector<FeatureColumn>& trip_feature_columns();

/// Trips of a database, latest import first, named by their SHA-256. They have no geometry: where
/// somebody drove is told by segments alone.
FeatureList trip_features(const std::filesystem::path& store);

} // namespace macadam
