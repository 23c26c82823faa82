#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/analysis/worst_sections.hpp"
#include "render/report/document/document.hpp"
#include "render/scene/scene.hpp"
#include "storage/store/road_store.hpp"

#include <cstddef>
#include <vector>

namespace macadam {

/// What pictures are for: screens, light and dark, or print.
enum class PictureUse { screen, paper };

/// The look of a report's maps in one of its themes. A style's own colours are for pages as dark as
/// its theme; the others have the theme's.
MapStyle in_theme(MapStyle style, MapStyle::Theme theme);

/// Draws pictures of a report, and tells how far it is.
class ReportPictures {
public:
    /// \param count  how many there will be
    ReportPictures(const MapStyle& style,
                   PictureUse use,
                   const Progress& progress,
                   std::size_t count);

    /// \param classes      how many classes the scene's lines have: null as the report's.
    /// \throws InputError  if it is told to stop.
    ReportPicture map(const MapScene& scene, const ClassTable* classes = nullptr);
    ReportPicture stretch(const MapScene& scene, const ClassTable* classes = nullptr);

    /// Of the ground, from side to side of a map.
    double map_width_m(const MapScene& scene) const;

private:
    ReportPicture
    draw(const MapScene& scene, int width_px, int height_px, const ClassTable* classes);

    MapStyle style_;
    PictureUse use_;
    const Progress& progress_;
    std::size_t count_;
    std::size_t drawn_ = 0;
};

/// All roads of a store, without what the page says itself.
MapScene whole_scene(const RoadStore& store, const MapStyle& style);

/// Around a stretch, with all roads quiet.
MapScene
quiet_scene(const RoadStore& store, const WorstSection& stretch, const ClassTable& classes);

/// The stretch alone in the colours of its segments, however few passes they have, all other roads
/// quiet: what is meant is seen at a glance.
MapScene stretch_scene(const RoadStore& store,
                       const WorstSection& stretch,
                       const std::vector<SegmentRecord>& measured,
                       const ClassTable& classes);

} // namespace macadam
