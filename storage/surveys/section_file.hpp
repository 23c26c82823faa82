#pragma once

#include "estimator/common/geo.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// A section as an agency names it: by a road and where on it, or by its line.
struct SectionReference {
    std::string where; ///< "file:line", for messages; the file alone for a line
    std::string name;  ///< of the section
    std::string route; ///< name of the road, "" = by way or line
    std::optional<std::int64_t> way_id{};
    std::optional<double> from_m{}; ///< along the road or way; nothing: all of it
    std::optional<double> to_m{};
    std::optional<bool> forward{};
    std::vector<GeoPoint> line{};
};

/// Sections of a table (.csv), a GPX track, or a line layer that GDAL reads
/// (docs/reference/sections.md says which columns).
///
/// \throws InputError  "file:line: ..." for columns or cells that are not what is expected, or if
///                     there is no section.
std::vector<SectionReference> read_sections(const std::filesystem::path& file);

} // namespace macadam
