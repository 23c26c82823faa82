#pragma once

#include <string>

class GDALDataset;

namespace macadam {

/// Copyright notice of a raster, on one line, without mark-up; "" if it has none.
std::string attribution_of(GDALDataset& raster);

} // namespace macadam
