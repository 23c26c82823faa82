#include "app/segment_options.hpp"

#include <fmt/format.h>

namespace macadam {

std::filesystem::path store_file(const Arguments& arguments) {
    const auto& store = arguments.operand("STORE");
    if (store.find("://") != std::string::npos) {
        throw UsageError{fmt::format("STORE is '{}', expected a .gpkg file", store)};
    }
    return store;
}

GeoBox box_of(const std::vector<double>& degrees) {
    const GeoBox box{degrees[0], degrees[1], degrees[2], degrees[3]};
    const bool on_globe =
        box.west_deg >= -180 && box.east_deg <= 180 && box.south_deg >= -90 && box.north_deg <= 90;
    if (!on_globe || !(box.west_deg < box.east_deg && box.south_deg < box.north_deg)) {
        throw UsageError{
            fmt::format("--bbox is {},{},{},{}, expected west < east and south < north in degrees",
                        degrees[0],
                        degrees[1],
                        degrees[2],
                        degrees[3])};
    }
    return box;
}

SegmentFilter parse_filter(const Arguments& arguments) {
    SegmentFilter filter;
    if (const auto degrees = arguments.numbers("--bbox", 4)) {
        filter.box = box_of(*degrees);
    }
    filter.way_id = arguments.integer("--way");
    filter.name_part = arguments.value("--name").value_or("");
    filter.with_state_only = !arguments.flag("--all");
    return filter;
}

void warn_of_waiting(const RoadStore& store,
                     const std::filesystem::path& file,
                     const Console& console) {
    if (const auto waiting = store.waiting(); waiting > 0) {
        console.warn(fmt::format(
            "{}: {} segments have passes that are not fused yet; an import was cut off, run "
            "'macadam import' again",
            file.string(),
            waiting));
    }
}

} // namespace macadam
