#pragma once

#include "estimator/common/geo.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

// What storage/export.cpp asks of the late library macadam_gdal.

struct FlatGeobufColumn {
    enum class Type : std::uint8_t { text, integer, real, time };
    std::string_view name;
    Type type;
};

struct FlatGeobufLayer {
    std::filesystem::path file; ///< not there yet; its name ends in .fgb
    std::string name;
    std::string description;
    std::vector<FlatGeobufColumn> columns;
};

/// Adds one line with the values of the columns as text; nothing: not known.
using FlatGeobufPut = std::function<void(const std::vector<GeoPoint>& line,
                                         const std::vector<std::optional<std::string>>& values)>;

/// Makes a FlatGeobuf file with a spatial index of the lines that `give` puts.
///
/// \throws InputError  with GDAL's complaint, without the file's name, if it cannot be written; and
///                     what `give` throws. No file is left then.
using FlatGeobufWrite = void(const FlatGeobufLayer& layer,
                             const std::function<void(const FlatGeobufPut& put)>& give);
inline constexpr const char* flatgeobuf_write_name = "macadam_flatgeobuf_write";

} // namespace macadam
