#pragma once

#include "app/serve/features/feature.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <memory>
#include <vector>

namespace macadam {

/// Features of one version of the database that are few enough to be kept.
struct FeatureList {
    std::vector<Feature> features;
    std::shared_ptr<const void> rows; ///< that they refer to
};

/// Columns of the worst sections (docs/reference/report.md).
const std::vector<FeatureColumn>& worst_feature_columns();

/// Sections of poor road, roughest first, as `query --worst` finds them.
FeatureList worst_features(const StoreReader& store);

/// Columns of events (docs/reference/exports.md).
const std::vector<FeatureColumn>& event_feature_columns();

/// Potholes and other events in the order of `export --events`.
FeatureList event_features(const StoreReader& store);

} // namespace macadam
