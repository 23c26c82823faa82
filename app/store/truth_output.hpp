#pragma once

#include "mapping/surveys/truth_comparison.hpp"
#include "storage/store/road_store.hpp"

#include <filesystem>
#include <string>

namespace macadam {

/// The states of a store against a truth file.
///
/// \throws InputError  if the file is no truth, or not of this store's segments.
TruthComparison compared(const RoadStore& store, const std::filesystem::path& truth);

/// A small table by class of road.
std::string text_of(const TruthComparison& comparison);

/// One JSON object.
std::string json_of(const TruthComparison& comparison);

} // namespace macadam
