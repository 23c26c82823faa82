#pragma once

#include "app/render/map_scene.hpp"
#include "estimator/common/progress.hpp"
#include "mapping/analysis/worst_sections.hpp"
#include "mapping/fusion/measured_segment.hpp"
#include "render/report/document/document.hpp"
#include "render/scene/scene.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <cstddef>
#include <vector>

namespace macadam {

/// Medium of the pictures: screens (light and dark) or print.
enum class PictureUse { screen, paper };

/// Scene of a picture and what lies below its roads.
struct ReportScene {
    MapScene scene;
    MapBackground background{};
};

/// Returns the style of a report's maps in one of its themes. A style's own colours apply to pages
/// as dark as its theme; other pages use the colours of the theme.
MapStyle in_theme(MapStyle style, MapStyle::Theme theme);

/// Draws the pictures of a report and reports progress.
class ReportPictures {
public:
    /// \param count  total number of pictures
    ReportPictures(const MapStyle& style,
                   PictureUse use,
                   const Progress& progress,
                   std::size_t count);

    /// Announces further pictures.
    void expect_more(std::size_t count) { count_ += count; }

    /// Draws a picture of the size for maps or for sections, of roughness or of changes.
    /// \throws InputError  on a stop request.
    ReportPicture map(ReportScene map, bool is_of_changes = false);
    ReportPicture stretch(MapScene scene, bool is_of_changes = false);

    /// Returns the width of a map on the ground.
    double map_width_m(const MapScene& scene) const;

private:
    ReportPicture draw(ReportScene map, const PictureSize& size, bool is_of_changes);

    MapStyle style_;
    PictureUse use_;
    const Progress& progress_;
    std::size_t count_;
    std::size_t drawn_ = 0;
};

/// Builds a scene of all roads, or of those that a filter selects, without the text that the page
/// has itself.
///
/// \param lines  as of load_map
ReportScene whole_scene(const StoreReader& store,
                        const MapStyle& style,
                        PictureUse use,
                        const SegmentFilter& filter = {},
                        const LoadLines& lines = {});

/// Builds a scene around a section, with all roads muted.
MapScene
quiet_scene(const StoreReader& store, const WorstSection& stretch, const ClassTable& classes);

/// Builds a scene of one section in the colours of its segments, however few passes they have,
/// drawn wider than its neighbours, which have their names and colours.
MapScene stretch_scene(const StoreReader& store,
                       const WorstSection& stretch,
                       const std::vector<MeasuredSegment>& measured,
                       const ClassTable& classes);

} // namespace macadam
