#pragma once

#include "storage/tables/excel_csv.hpp"
#include "storage/text/unit_system.hpp"

#include <functional>
#include <optional>
#include <string_view>

namespace macadam {

using PutText = std::function<void(std::string_view)>;

/// Units of exported files, and options of those that are text: .geojson, .geojsonl, .csv and .kml.
struct TextExport {
    UnitSystem units = UnitSystem::si;
    std::optional<ExcelDialect> excel{}; ///< of .csv; `std::nullopt`: commas and points
    PutText put{};                       ///< takes the text instead of the file, whose name then
                                         ///< selects the format; empty: the file
};

} // namespace macadam
