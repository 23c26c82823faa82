#pragma once

#include <string>

class OGRSpatialReference;

namespace macadam {

/// Checks the grid files of a coordinate system. PROJ opens the shift grids that a definition
/// names; only plain names are accepted, which PROJ looks up in its own folders.
///
/// \throws InputError  "FILE: ..." if a grid is named by a path.
void expect_grids_of_proj(const OGRSpatialReference& system, const std::string& file);

} // namespace macadam
