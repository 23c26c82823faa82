#pragma once

#include "estimator/common/geo.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace macadam {

/// Makes of a FlatGeobuf file without a spatial index one with it: the features in the order of a
/// Hilbert curve, and before them the packed R-tree that clients use to fetch a part of the file.
/// Memory: 50 bytes for each feature, a third of what GDAL takes for the same.
///
/// \param plain  what GDAL writes with SPATIAL_INDEX=NO.
/// \param boxes  of its features, in their order; one at least.
/// \param file   where to.
/// \throws InputError  if `plain` is not such a file, or `file` cannot be written. The message
///                     names no file.
///
/// Source: FlatGeobuf 3, "Binary layout" and "Spatial index" (flatgeobuf.org); the tree is that of
/// `packedrtree`, with 16 children a node.
void index_flatgeobuf(const std::filesystem::path& plain,
                      std::vector<GeoBox> boxes,
                      const std::filesystem::path& file);

} // namespace macadam
