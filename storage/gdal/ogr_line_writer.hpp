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

// What storage/exports/export_gdal.cpp asks of the plug-in macadam_gdal.

struct LineFileColumn {
    enum class Type : std::uint8_t { text, integer, real, day };
    std::string_view name;
    Type type;
    int width = 0; ///< bytes, where the kind of file has columns of a width
    int decimals = 0;
};

/// A file of one layer of lines in WGS 84.
struct LineFile {
    const char* driver;         ///< as GDAL calls it: "FlatGeobuf", "ESRI Shapefile"
    std::filesystem::path file; ///< not there yet; its name has the suffix that the driver expects
    std::string layer;
    std::vector<std::pair<std::string, std::string>> options; ///< of the layer, as GDAL calls them
    std::vector<LineFileColumn> columns;
};

using LineParts = std::vector<std::vector<GeoPoint>>;

/// Adds one line, in one part or more, with the values of the columns as text; nothing: not known.
using LinePut = std::function<void(const LineParts& parts,
                                   const std::vector<std::optional<std::string>>& values)>;

/// Makes a file of the lines that `give` puts.
///
/// \throws InputError  with GDAL's complaint, without the file's name, if it cannot be written; and
///                     what `give` throws. Half a file may be left then.
using LineFileWrite = void(const LineFile& file,
                           const std::function<void(const LinePut& put)>& give);
inline constexpr const char* line_file_write_name = "macadam_line_file_write";

} // namespace macadam
