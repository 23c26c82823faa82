#pragma once

#include "app/query/section_options.hpp"
#include "app/report/report_maps.hpp"
#include "estimator/common/progress.hpp"
#include "render/report/report.hpp"
#include "storage/store/road_store.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace macadam {

struct ReportConfig {
    std::string title;
    std::size_t worst = 20;                   ///< stretches to list
    std::optional<SectionOptions> sections{}; ///< to list
    std::optional<std::int64_t> since_ms{};   ///< day from which on changes are looked for
    Localisation wording{};
    PictureUse pictures = PictureUse::screen;
    MapStyle style; ///< of the maps, with its classes; their colours are those of tables, too
};

/// All that a report of a store says, with its pictures.
/// \param progress  is told of pictures drawn; a stop ends it. \throws InputError if stopped.
Report report_of(const RoadStore& store, const ReportConfig& config, const Progress& progress = {});

} // namespace macadam
