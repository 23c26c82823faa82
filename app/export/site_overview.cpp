#include "app/export/site_overview.hpp"

#include "app/render/map_scene.hpp"
#include "app/render/picture_output.hpp"
#include "estimator/common/angle.hpp"
#include "estimator/common/error.hpp"
#include "mapping/style/iri_class.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

// Sharp in a browser's window; the first picture is soon there: at most half a megabyte.
constexpr PictureSize size{.width_px = 1200, .height_px = 900};
constexpr PictureSize first_size{.width_px = 640, .height_px = 480};
constexpr double min_side_deg = 0.002; // of the first picture, of longitude
constexpr double max_shape = 3;        // of the first picture, long to short side

/// Draws a picture, or says why not.
bool is_drawn(const Progress& progress, const Console& console, const std::function<void()>& draw) {
    try {
        draw();
        return true;
    } catch (const InputError& failed) {
        if (progress.stop.stop_requested()) {
            throw;
        }
        console.warn(fmt::format("the site has no picture of all roads: {}", failed.what()));
        return false;
    }
}

/// Returns a box around the roads with a margin, neither flat nor a mere strip in spherical
/// Mercator.
GeoBox picture_box(const GeoBox& roads) {
    const double middle_deg = (roads.south_deg + roads.north_deg) / 2;
    const double deg_per_lon_deg = std::cos(middle_deg * rad_per_deg); // of latitude, as wide
    double half_width = (roads.east_deg - roads.west_deg) / 2 * 1.02;
    double half_height = (roads.north_deg - roads.south_deg) / 2 / deg_per_lon_deg * 1.02;
    half_width = std::max({half_width, half_height / max_shape, min_side_deg / 2});
    half_height = std::max(half_height, half_width / max_shape);
    const double lon_deg = (roads.west_deg + roads.east_deg) / 2;
    return {.west_deg = lon_deg - half_width,
            .south_deg = middle_deg - half_height * deg_per_lon_deg,
            .east_deg = lon_deg + half_width,
            .north_deg = middle_deg + half_height * deg_per_lon_deg};
}

} // namespace

bool write_overview(const StoreReader& store,
                    const SegmentFilter& filter,
                    const std::filesystem::path& file,
                    const std::string& title,
                    bool left_hand,
                    const Console& console) {
    MapRequest request{.filter = filter, .title = title, .size = size};
    request.style.classes = class_table(store.settings().class_table);
    request.style.left_hand_traffic = left_hand;
    const PictureOutput output{.file = file, .size = size, .crs = {}};
    const auto progress = console.progress("drawing");
    return is_drawn(progress, console, [&] {
        write_picture(load_map(store, request), output, "", progress, [] {});
    });
}

std::optional<GeoBox> write_first_pictures(const StoreReader& store,
                                           const SegmentFilter& filter,
                                           const std::filesystem::path& folder,
                                           const GeoBox& bounds,
                                           bool left_hand,
                                           const Console& console) {
    MapRequest request{.filter = filter, .size = first_size};
    request.filter.box = picture_box(bounds);
    request.style.classes = class_table(store.settings().class_table);
    request.style.left_hand_traffic = left_hand;
    request.style.labels = false;
    request.subtitle = ""; // they have none
    const auto progress = console.progress("drawing");
    const auto draw = [&](std::string_view name, MapScene scene, MapStyle style) {
        const PictureOutput output{
            .file = folder / name, .size = first_size, .bare = true, .crs = {}};
        write_picture(
            MapPlan{std::move(scene), std::move(style), first_size}, output, "", progress, [] {});
    };
    const bool drawn = is_drawn(progress, console, [&] {
        auto plan = load_map(store, request); // once: themes differ in colours alone
        auto style = plan.style();
        style.theme = MapStyle::Theme::light;
        style.colours.ground = 0xeef1f3; // --ground of web/src/site.css
        draw("first_light.png", plan.scene(), style);
        style.theme = MapStyle::Theme::dark;
        style.colours.ground = 0x10161c;
        draw("first_dark.png", std::move(plan).scene(), style);
    });
    return drawn ? request.filter.box : std::nullopt;
}

} // namespace macadam
