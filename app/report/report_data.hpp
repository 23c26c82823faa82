#pragma once

#include "app/query/section_options.hpp"
#include "app/report/report_maps.hpp"
#include "app/report/route_strips.hpp"
#include "estimator/common/progress.hpp"
#include "render/report/report.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace macadam {

struct ReportConfig {
    std::string title;
    std::size_t worst = 20;                   ///< number of sections to list
    std::optional<SectionOptions> sections{}; ///< sections to list
    std::optional<StripRoad> strip{};         ///< road of the strip chart
    SegmentFilter filter{};                   ///< segments and passes to report
    std::string selection{};                  ///< the filter in words; "" = none
    std::optional<std::int64_t> since_ms{};   ///< first day of the period checked for changes
    bool events = true;                       ///< lists potholes and other events
    Localisation wording{};
    PictureUse pictures = PictureUse::screen;
    MapStyle style; ///< style of the maps, with its classes; tables use the same colours
};

/// Collects the data of a database report, with its pictures.
/// \param progress     counts the pictures drawn
/// \throws InputError  on a stop request.
Report
report_of(const StoreReader& store, const ReportConfig& config, const Progress& progress = {});

} // namespace macadam
