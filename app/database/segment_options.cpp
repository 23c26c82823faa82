#include "app/database/segment_options.hpp"

#include "estimator/common/error.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/networks/osm_tags.hpp"
#include "storage/store/connection/import_lock.hpp"
#include "storage/text/spelling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace macadam {

std::filesystem::path store_file(const Arguments& arguments) {
    const auto& store = arguments.operand("STORE");
    if (store.find("://") != std::string::npos) {
        throw UsageError{fmt::format("STORE is '{}', expected a .gpkg file", store)};
    }
    return store;
}

GeoBox box_of(const std::vector<double>& degrees) {
    const auto west_deg = degrees[0], south_deg = degrees[1];
    const auto east_deg = degrees[2], north_deg = degrees[3];
    const auto is_longitude = [](double deg) { return deg >= -180 && deg <= 180; };
    const bool on_globe =
        is_longitude(west_deg) && is_longitude(east_deg) && south_deg >= -90 && north_deg <= 90;
    if (!on_globe || west_deg == east_deg || !(south_deg < north_deg)) {
        throw UsageError{fmt::format("--bbox is {},{},{},{}, expected west,south,east,north in "
                                     "degrees with south < north; west > east crosses the "
                                     "antimeridian",
                                     west_deg,
                                     south_deg,
                                     east_deg,
                                     north_deg)};
    }
    return {west_deg, south_deg, west_deg > east_deg ? east_deg + 360 : east_deg, north_deg};
}

std::optional<SegmentKey> parse_key(const Arguments& arguments) {
    const auto key = arguments.value("--segment");
    try {
        return key ? std::optional{parse_segment_key(*key)} : std::nullopt;
    } catch (const InputError& error) {
        throw UsageError{fmt::format("--segment: {}", error.what())};
    }
}

void expect_known_highway(const SegmentFilter& filter, const StoreReader& store) {
    if (filter.highway.empty() || is_car_class(filter.highway)) {
        return;
    }
    const auto known = store.highways();
    if (std::ranges::find(known, filter.highway) == known.end()) {
        throw UsageError{fmt::format("--highway is '{}', expected {}{}",
                                     filter.highway,
                                     fmt::join(known, " or "),
                                     suggestion(filter.highway, known))};
    }
}

void expect_known_class(const SegmentFilter& filter, const StoreReader& store) {
    const auto& classes = class_table(store.settings().class_table)->classes;
    if (!filter.class_name.empty() &&
        std::ranges::find(classes, filter.class_name, &IriClass::name) == classes.end()) {
        std::vector<std::string_view> names;
        std::ranges::transform(classes, std::back_inserter(names), &IriClass::name);
        throw UsageError{fmt::format(
            "--class is '{}', expected {}", filter.class_name, fmt::join(names, " or "))};
    }
}

void warn_of_waiting(const StoreReader& store,
                     const std::filesystem::path& file,
                     const Console& console) {
    bool is_running = is_import_running(file);
    auto waiting = store.waiting();
    if (!is_running && waiting > 0) { // an import may have begun or ended meanwhile
        is_running = is_import_running(file);
        waiting = store.waiting();
    }
    const auto segments = counted(waiting, "segment");
    if (is_running) {
        console.say(fmt::format("{}: an import is running; values hold what it has fused so far{}",
                                file.string(),
                                waiting > 0 ? fmt::format(", {} not yet", segments) : ""));
    } else if (waiting > 0) {
        console.warn(fmt::format("{}: {} {} passes that are not fused yet because an import was "
                                 "interrupted; run 'macadam import' again",
                                 file.string(),
                                 segments,
                                 waiting == 1 ? "has" : "have"));
    }
}

} // namespace macadam
