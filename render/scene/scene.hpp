#pragma once

#include "estimator/common/geo.hpp"
#include "estimator/common/progress.hpp"
#include "mapping/style/base_map.hpp"
#include "mapping/style/iri_class.hpp"
#include "mapping/style/map_style_values.hpp"
#include "render/projection/crs_projection.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// A piece of road on the map, in driving direction. Consecutive pieces that touch and look alike
/// are joined before they are drawn.
struct MapLine {
    std::vector<GeoPoint> line;
    int iri_class = -1;      ///< in the class table; -1: road without a measurement, drawn quietly
    bool both_ways = false;  ///< the other direction is a line of its own: each keeps to its side
    bool forward = true;     ///< along its way; of a pair of both_ways lines one is false
    int rank = 0;            ///< 0 motorway .. 5 service: of the width
    bool certain = true;     ///< false: few passes or a wide interval, drawn thinner
    bool few_passes = false; ///< fewer than the picture asks for: grey in a casing, whatever its
                             ///< class
    std::string name;        ///< of the road, for its label
};

struct MapStyle {
    enum class Theme { light, dark, print };
    Theme theme = Theme::light;
    std::string ramp = "rdylbu";                ///< one of colour_ramps()
    std::vector<std::uint32_t> own_ramp{};      ///< 0xRRGGBB from smooth to rough; empty: `ramp`
    const ClassTable* classes = nullptr;        ///< null: fhwa
    std::optional<OwnClassTable> own_classes{}; ///< keeps what `classes` points at, where it is own
    ThemeColours colours{};                     ///< instead of the theme's
    LineFactors lines{};
    LegendWords words{};
    int min_passes = 1; ///< that few_passes of the lines speaks of
    bool left_hand_traffic = false;
    bool in_per_mi = false;    ///< legend in in/mi
    bool labels = true;        ///< the names of roads along them
    bool legend = true;        ///< false: none, where the page around the picture has its own
    double base_opacity = 0.5; ///< of the base map: 0 none of it, 1 none of the ground
};

struct MapScene {
    /// What must be in the picture; widened to its shape. Where its east lies beyond 180 degrees it
    /// goes on over the antimeridian, and so do the longitudes of the lines.
    GeoBox box;
    std::vector<MapLine> lines;
    std::string title;
    std::string subtitle;         ///< period, kilometres, cars
    std::string attribution;      ///< whose data
    std::vector<double> class_km; ///< length of each class, for the legend; empty: not shown
    bool scale_bar = true;        ///< with north arrow; false: the words around say how large it is
    bool to_the_edge = false;     ///< the box fills the map; else it keeps away from its edges
    std::shared_ptr<const PlaneProjection> projection{}; ///< null: spherical Mercator
    std::shared_ptr<const BaseMap> base{}; ///< under the roads; null: the ground is of one colour
};

/// Eight-bit RGB, top row first.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb; ///< width * height * 3
};

inline constexpr int min_image_px = 256;
inline constexpr int max_image_px = 32768;

struct PictureSize {
    int width_px, height_px;
    int band_px = 0; ///< rows that are drawn at a time; 0: as many as make 8 million pixels
};

/// Takes rows of a picture as they are drawn, from the top, some whole ones at a time: eight-bit
/// RGB.
using TakeRows = std::function<void(std::span<const std::uint8_t> rgb)>;

/// The map with title, legend, scale bar, north arrow and attribution. Text and lines scale with
/// the picture, so that 512 and 8192 px read alike.
///
/// \throws InputError  for a size out of range, an empty box, an unknown ramp, a missing font, or
///                     if OSMesa cannot draw.
Image render_map(const MapScene& scene, const MapStyle& style, int width_px, int height_px);

/// The same picture, to the last byte, row by row: held are the roads and the rows of one band.
/// `progress` counts rows.
///
/// \throws InputError  as render_map does, and when it is told to stop.
void draw_map(const MapScene& scene,
              const MapStyle& style,
              const PictureSize& size,
              const TakeRows& take,
              const Progress& progress = {});

/// What of the globe that picture shows, up to its edges, also under title and legend; less than
/// nothing beyond is drawn. In spherical Mercator alone: it leaves the scene's projection out.
GeoBox ground_shown(const MapScene& scene, const MapStyle& style, int width_px, int height_px);

/// How much ground that picture shows from side to side, at half its height.
double ground_width_m(const MapScene& scene, const MapStyle& style, int width_px, int height_px);

/// Where the same picture lies on the plane of its projection.
PlanePlace place_of(const MapScene& scene, const MapStyle& style, int width_px, int height_px);

/// The picture as the bytes of a PNG file.
std::vector<std::uint8_t> encode_png(const Image& image);

/// sRGB of each class from smooth to rough, as 0xRRGGBB. \throws InputError for an unknown ramp.
std::vector<std::uint32_t> ramp_colours(std::string_view ramp, std::size_t classes);

} // namespace macadam
