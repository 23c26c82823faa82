#pragma once

#include <string>

class OGRSpatialReference;

namespace macadam {

/// A coordinate system may name grids of shifts, which PROJ opens as files. Only those are let
/// through that have a plain name, which PROJ looks up among its own.
///
/// \throws InputError  "FILE: ..." if one leads elsewhere.
void expect_grids_of_proj(const OGRSpatialReference& system, const std::string& file);

} // namespace macadam
