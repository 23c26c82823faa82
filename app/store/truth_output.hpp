#pragma once

#include "mapping/surveys/truth_comparison.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/text/unit_system.hpp"

#include <filesystem>
#include <string>

namespace macadam {

/// Compares the states of a database with a truth file.
///
/// \throws InputError  if the file is no truth, or not of this database's segments.
TruthComparison compared(const StoreReader& store, const std::filesystem::path& truth);

/// Formats a small table by class of road.
std::string text_of(const TruthComparison& comparison, UnitSystem units);

/// Formats one JSON object.
std::string json_of(const TruthComparison& comparison, UnitSystem units);

/// Formats a row for all segments, for each class of road, and for each band.
std::string csv_of(const TruthComparison& comparison, UnitSystem units);

} // namespace macadam
