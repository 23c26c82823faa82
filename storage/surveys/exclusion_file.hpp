#pragma once

#include "mapping/analysis/exclusion.hpp"

#include <filesystem>
#include <vector>

namespace macadam {

/// Places that must not count. A table (.csv) has lat_deg, lon_deg and perhaps radius_m; any other
/// file is a GPX track or a layer of lines that GDAL reads.
///
/// \param radius_m  of places that state none.
/// \throws InputError  "file:line: ..." for columns or cells that are not what is expected, or if
///                     there is no place.
std::vector<Exclusion> read_exclusions(const std::filesystem::path& file, double radius_m);

} // namespace macadam
