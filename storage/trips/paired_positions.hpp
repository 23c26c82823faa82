#pragma once

#include "storage/trips/source/trip_source.hpp"

#include <filesystem>
#include <optional>

namespace macadam {

/// Finds the file with the positions of a log that has none itself: beside it on disk, with the
/// same stem (storage/trips/positions/position_files.hpp). Phone exports, rawlogs and logs in
/// archives have no such file, and neither has a log that cannot be read.
std::optional<std::filesystem::path> paired_positions(const TripSource& source);

} // namespace macadam
