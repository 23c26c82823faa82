#pragma once

#include "estimator/common/geo.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Section as an agency defines it: by road and measures, or by a polyline.
struct SectionReference {
    std::string where; ///< "file:line", for messages; only the file for a polyline
    std::string name;  ///< name of the section
    std::string route; ///< name of the road; "" = by way or polyline
    std::optional<std::int64_t> way_id{};
    std::optional<double> from_m{}; ///< measure along the road or way; `std::nullopt`: all of it
    std::optional<double> to_m{};
    std::optional<bool> forward{};
    std::vector<GeoPoint> line{};
};

/// Reads sections from a table (.csv), a GPX track, or a line layer that GDAL reads
/// (docs/reference/sections.md lists the columns).
///
/// \throws InputError  "file:line: ..." for unexpected columns or invalid cells, or if the file
///                     holds no section or a line with points too far apart (longest_step_m).
std::vector<SectionReference> read_sections(const std::filesystem::path& file);

} // namespace macadam
