#pragma once

#include "estimator/common/geo.hpp"
#include "estimator/common/progress.hpp"
#include "estimator/events/road_event.hpp"
#include "mapping/style/base_map.hpp"
#include "mapping/style/iri_class.hpp"
#include "mapping/style/map_style_values.hpp"
#include "render/projection/crs_projection.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Rank of what a map is about: over all other roads, as wide as a motorway and with a wide edge
/// that sets it off from neighbours of the same colour.
inline constexpr int subject_rank = -1;

/// Interval of a road on the map, in driving direction. Consecutive intervals that touch and look
/// alike are joined before drawing.
struct MapLine {
    std::vector<GeoPoint> line;
    int iri_class = -1;      ///< in the class table; -1: road without a measurement
    bool both_ways = false;  ///< the other direction is a separate line: each keeps to its side
    bool forward = true;     ///< along its way; false for one of a pair of both_ways lines
    int rank = 0;            ///< 0 motorway .. 5 service, or subject_rank: determines the width
    bool certain = true;     ///< false: few passes or a wide interval, drawn thinner
    bool few_passes = false; ///< fewer than required: grey in a casing, regardless of class
    std::string name;        ///< of the road, for its label
    std::string number{};    ///< of the road, for shields, such as "A 9"

    /// From which the class follows; NaN: none, the class alone counts.
    double iri_mm_per_m = std::numeric_limits<double>::quiet_NaN();
};

/// Pothole or other event of the road, drawn as a symbol.
struct MapEvent {
    GeoPoint at;
    EventKind kind;
    Severity severity;
};

/// Place with a name for the map.
struct MapPlace {
    std::string name;
    int rank = 0; ///< 0 city, 1 town, 2 village, 3 suburb: size and priority of the name
    GeoPoint at;
    bool is_marked = false; ///< by something at its position, beside which its name stands
};

/// Part of the data on a map of its own beside the main one: far off the others, or a detail of
/// the main map at a larger scale.
struct MapInset {
    GeoBox box;
    std::string name;             ///< of a place in it, or ""
    double scale_denominator = 0; ///< of a detail; 0: a far-off part, which fills its map
};

struct MapStyle {
    enum class Theme { light, dark, print };
    Theme theme = Theme::light;
    std::string ramp = "rdylbu";                ///< one of colour_ramps()
    std::vector<std::uint32_t> own_ramp{};      ///< 0xRRGGBB from smooth to rough; empty: `ramp`
    const ClassTable* classes = nullptr;        ///< null: fhwa
    std::optional<OwnClassTable> own_classes{}; ///< storage of `classes` if it is custom
    ThemeColours colours{};                     ///< overrides of the theme's
    LineFactors lines{};
    LegendWords words{};
    int min_passes = 1; ///< threshold of the lines' few_passes
    bool left_hand_traffic = false;
    bool in_per_mi = false;    ///< legend in in/mi
    bool labels = true;        ///< names of roads along them
    bool legend = true;        ///< false: none, if the page around the picture has one
    double base_opacity = 0.5; ///< of the base map: 0 invisible, 1 hides the ground
};

struct MapScene {
    /// Box that the picture must contain; extended to the picture's shape. If its east lies beyond
    /// 180 degrees, it continues over the antimeridian, as do the longitudes of the lines.
    GeoBox box;
    GeoBox data_box{}; ///< of the data alone, if the box has ground beside it; empty: the box
    std::vector<MapLine> lines{};
    std::vector<MapEvent> events{}; ///< drawn over the roads, with entries in the legend
    std::vector<MapPlace> places{}; ///< named on the map, as far as there is room
    std::vector<MapInset> insets{}; ///< all far-off parts of the data, or all details
    std::string place{};            ///< name of a place in the box, for the locator of insets
    std::string title;
    std::string subtitle;         ///< period, kilometres, cars
    std::string attribution;      ///< copyright notice
    std::vector<double> class_km; ///< length of each class, for the legend; empty: omitted
    bool scale_bar = true;        ///< with north arrow; false: the surrounding text gives the scale
    bool to_the_edge = false;     ///< the box fills the map; else it has a margin
    double scale_denominator = 0; ///< on paper, 25000 for 1:25,000; 0: as large as fits
    std::shared_ptr<const PlaneProjection> projection{}; ///< null: spherical Mercator
    std::shared_ptr<const BaseMap> base{}; ///< under the roads; null: plain ground colour
};

/// Eight-bit RGB image, top row first.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb; ///< width * height * 3
};

inline constexpr int min_image_px = 256;
inline constexpr int max_image_px = 32768;

struct PictureSize {
    int width_px, height_px;
    int band_px = 0; ///< rows drawn at a time; 0: as many as make 8 million pixels

    /// On paper: lines and letters have the widths and heights that their map scale asks for. 0: a
    /// picture for a page that scales it: the shorter side counts as 265 mm.
    double px_per_inch = 0;

    bool is_on_paper = false; ///< its size is that of a sheet: the map states its scale
};

/// Receiver of rows of a picture as they are drawn, from the top, in groups of whole rows:
/// eight-bit RGB.
using TakeRows = std::function<void(std::span<const std::uint8_t> rgb)>;

/// Encodes the picture as the bytes of a PNG file.
std::vector<std::uint8_t> encode_png(const Image& image);

/// Returns the sRGB colour of each class from smooth to rough, as 0xRRGGBB. \throws InputError  for
/// an unknown ramp.
std::vector<std::uint32_t> ramp_colours(std::string_view ramp, std::size_t classes);

} // namespace macadam
