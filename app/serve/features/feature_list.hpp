#pragma once

#include "app/query/section_options.hpp"
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

/// Columns of an agency's own sections (docs/reference/sections.md).
const std::vector<FeatureColumn>& section_feature_columns();

/// An agency's own sections in the order of their file, numbered from 1.
/// \throws InputError  for an invalid file, and for roads that are not found.
FeatureList section_features(const StoreReader& store, const SectionOptions& sections);

} // namespace macadam
