#pragma once

#include "mapping/analysis/exclusion.hpp"

#include <filesystem>
#include <vector>

namespace macadam {

/// Reads places to exclude. A table (.csv) has lat_deg, lon_deg and optionally radius_m; any other
/// file is a GPX track or a line layer that GDAL reads.
///
/// \param radius_m  radius of places that state none.
/// \throws InputError  "file:line: ..." for unexpected columns or invalid cells, or if the file
///                     holds no place.
std::vector<Exclusion> read_exclusions(const std::filesystem::path& file, double radius_m);

} // namespace macadam
