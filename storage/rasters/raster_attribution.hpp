#pragma once

#include <string>

class GDALDataset;

namespace macadam {

/// Whose a raster is, on one line, without mark-up; "" = it names nobody.
std::string attribution_of(GDALDataset& raster);

} // namespace macadam
