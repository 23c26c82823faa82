#include "app/export/site_overview.hpp"

#include "app/render/map_scene.hpp"
#include "app/render/picture_output.hpp"
#include "estimator/common/error.hpp"
#include "mapping/style/iri_class.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

constexpr int width_px = 1200, height_px = 900; // sharp in a browser's window, some 200 kB

} // namespace

bool write_overview(const StoreReader& store,
                    const SegmentFilter& filter,
                    const std::filesystem::path& file,
                    const std::string& title,
                    bool left_hand,
                    const Console& console) {
    MapRequest request{
        .filter = filter, .title = title, .width_px = width_px, .height_px = height_px};
    request.style.classes = class_table(store.settings().class_table);
    request.style.left_hand_traffic = left_hand;
    const PictureOutput output{
        .file = file, .width_px = width_px, .height_px = height_px, .crs = {}};
    const auto progress = console.progress("drawing");
    try {
        write_picture(load_map(store, request), output, "", progress, [] {});
        return true;
    } catch (const InputError& failed) {
        if (progress.stop.stop_requested()) {
            throw;
        }
        console.warn(fmt::format("the site has no picture of all roads: {}", failed.what()));
        return false;
    }
}

} // namespace macadam
