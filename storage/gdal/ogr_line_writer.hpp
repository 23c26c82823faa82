#pragma once

#include "estimator/common/geo.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {

// Interface between storage/exports/export_gdal.cpp and the plug-in macadam_gdal.

struct LineFileColumn {
    enum class Type : std::uint8_t { text, integer, real, day };
    std::string_view name;
    Type type;
    int width = 0; ///< in bytes, for formats with fixed column widths
    int decimals = 0;
};

/// File with one layer of lines in WGS 84.
struct LineFile {
    const char* driver;         ///< GDAL's name: "FlatGeobuf", "ESRI Shapefile"
    std::filesystem::path file; ///< must not exist; with the suffix that the driver expects
    std::string layer;
    std::vector<std::pair<std::string, std::string>> options; ///< layer creation options of GDAL
    std::vector<LineFileColumn> columns;
};

using LineParts = std::vector<std::vector<GeoPoint>>;

/// Adds a line of one or more parts with its column values as text; `std::nullopt` is NULL.
using LinePut = std::function<void(const LineParts& parts,
                                   const std::vector<std::optional<std::string>>& values)>;

/// Writes the lines that `give` puts to a file.
///
/// \throws InputError  with GDAL's message, without the file name, if the file cannot be written;
///                     also exceptions of `give`. A partial file may remain.
using LineFileWrite = void(const LineFile& file,
                           const std::function<void(const LinePut& put)>& give);
inline constexpr const char* line_file_write_name = "macadam_line_file_write";

} // namespace macadam
