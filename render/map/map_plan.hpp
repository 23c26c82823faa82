#pragma once

#include "mapping/background/background.hpp"
#include "mapping/background/background_levels.hpp"
#include "mapping/background/background_pieces.hpp"
#include "render/background/background_fade.hpp"
#include "render/canvas/pdf_page.hpp"
#include "render/map/sheet/layout.hpp"
#include "render/map/sheet/legend_placement.hpp"
#include "render/map/sheet/map_insets.hpp"
#include "render/map/sheet/map_surround.hpp"
#include "render/scene/scene.hpp"
#include "render/text/text_shaping.hpp"

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace macadam {

/// Features and names below the roads of a map.
struct MapBackground {
    std::vector<BackgroundTile> tiles{}; ///< of MapPlan::background_level(); none over a base map
    std::vector<PlaceName> places{};     ///< the most important first
};

/// Map on a picture. Its texts are set once, when it is planned from a scene without lines; then
/// the lines on its ground are loaded, beside which it places the legend; then it is drawn:
///
///     MapPlan plan{scene, style, size};
///     plan.set_background(load(plan.background_level(), plan.ground()));
///     plan.set_roads(load(plan.ground()));
///     plan.draw(take);
class MapPlan {
public:
    /// \param style  its classes must outlive the plan
    /// \throws InputError  for a size out of range, an empty box, or a missing font
    MapPlan(MapScene scene, MapStyle style, const PictureSize& size);

    /// Returns the area whose roads are needed: that of the picture up to its edges, also under
    /// title and legend, with a margin for thick lines and labels that cross the edges. In a
    /// projection whose visible extent is unknown it is the box, grown by far.
    GeoBox ground() const;

    /// Sets the roads and the events on them; roads too minor for the map's scale are left out. The
    /// legend takes a corner without roads, or a band below of a sheet of which a quarter would be
    /// empty, unless a background is set; if there is neither, the map makes room for it and needs
    /// the roads of a larger ground.
    void set_roads(std::vector<MapLine> lines, std::vector<MapEvent> events = {});

    /// Returns the level of the background that serves the map's scale.
    const BackgroundLevel& background_level() const;

    /// Sets what lies below the roads of the ground.
    void set_background(MapBackground background);

    /// Returns the maps of the scene's insets, which need roads and background of their own.
    std::span<MapPlan> insets() { return std::span{insets_}.first(scene_.insets.size()); }

    /// Returns the map around all parts of the data, which needs a background alone; null without
    /// far-off parts.
    MapPlan* locator() { return insets_.size() > scene_.insets.size() ? &insets_.back() : nullptr; }

    /// Returns the details that would fill a sheet of which a quarter or more is empty.
    /// `std::nullopt` if it is not, or if the data leaves too little room for them.
    std::optional<DetailRoom> detail_room();

    /// Returns the ground that the map shows at its scale, as room for one area.
    DetailRoom room() const {
        const double m_per_px =
            metres_per_px(placement_.frame, (layout_.map.top + layout_.map.bottom) / 2);
        return {.count = 1,
                .scale_denominator = scale(),
                .width_m = layout_.map.width() * m_per_px,
                .height_m = layout_.map.height() * m_per_px};
    }

    /// Returns the share of the sheet without text, legend or data, 0 to 1.
    double empty_share() const { return macadam::empty_share(scene_, layout_, placement_); }

    const MapScene& scene() const& { return scene_; }
    MapScene scene() && { return std::move(scene_); }
    MapBackground background() && { return std::move(background_); }
    const MapStyle& style() const { return style_; }
    const PictureSize& size() const { return size_; }

    /// Returns the position of the picture on the plane of its projection.
    PlanePosition place() const;

    /// Returns the denominator of the scale on paper at half the map's height: 25000 for 1:25,000.
    double scale() const;

    /// Returns the ground width of the picture at half its height.
    double ground_width_m() const;

    /// Draws the map with title, legend, scale bar, north arrow and attribution, row by row: only
    /// the roads and one band of rows are in memory. Text and lines scale with the picture, so that
    /// 512 and 8192 px look alike. `progress` counts rows.
    ///
    /// \throws InputError  for an unknown ramp or class, if OpenGL cannot draw, and when it is
    ///                     stopped.
    void draw(const TakeRows& take, const Progress& progress = {});

    /// Returns the map as the bytes of a PDF file, with vector lines and text and the same layout.
    ///
    /// \param sheet  of the plan's size
    /// \throws InputError  as draw, and if Cairo cannot write it.
    std::string pdf(const PdfSheet& sheet);

private:
    void plan_insets();
    std::optional<BackgroundFade> fade_of(std::span<const BackgroundShape> shapes) const;
    void plan_details();
    PictureSize inset_size(const PixelBox& box) const;
    void place_legend(const Legend& legend);
    void draw_on(PdfPage& page);
    void draw_sheet(DrawTarget& target);

    MapScene scene_;
    MapStyle style_;
    PictureSize size_;
    TypeSetter setter_;
    Layout layout_;
    MapBackground background_;
    GeoBox network_{}; ///< box of the roads that were set
    Placement placement_;
    std::vector<MapPlan> insets_{};         ///< the last is the locator
    std::vector<PixelBox> inset_boxes_{};   ///< on the sheet
    std::optional<PixelBox> legend_room_{}; ///< beside or below the map, above details
};

/// Draws a plan as one picture.
Image image_of(MapPlan& plan);

/// Plans and draws a scene with its lines.
Image render_map(const MapScene& scene, const MapStyle& style, const PictureSize& size);

} // namespace macadam
