#include "storage/rasters/base_map_plugin.hpp"

#include "storage/rasters/raster_warper.hpp"

namespace macadam {
namespace {

void open(const std::filesystem::path& file, BaseMap& map) {
    auto raster = std::make_shared<const RasterFile>(file);
    map.attribution = raster->attribution();
    for (const auto& each : raster->files()) {
        map.files.push_back(each.string());
    }
    map.laid_on = [raster](const PicturePlane& plane) -> PaintPart {
        auto painter = std::make_shared<const RasterWarper>(raster, plane);
        return [painter](const PicturePart& part) { return painter->rgba(part); };
    };
}

} // namespace
} // namespace macadam

extern "C" void macadam_base_map_open(const std::filesystem::path& file, macadam::BaseMap& map) {
    macadam::open(file, map);
}
