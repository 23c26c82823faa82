#pragma once

#include "estimator/common/geo.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace macadam::testing {

/// Reads a file of segments with GDAL's own tool: a GeoJSON collection, coordinates to nine
/// decimals.
nlohmann::json collection_by_gdal(const std::filesystem::path& folder, const std::string& name);

void expect_line(const nlohmann::json& coordinates,
                 const std::vector<GeoPoint>& line,
                 double tolerance_deg);

inline constexpr double seven_decimals_deg = 6e-8;

} // namespace macadam::testing
