#include "app/database/selection.hpp"

#include "app/database/car_names.hpp"

#include "storage/surveys/area_file.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <memory>

namespace macadam {
namespace {

std::int32_t parse_count(const Arguments& arguments, std::string_view name) {
    const auto count = arguments.integer(name).value_or(0);
    if (count < 0 || count > std::numeric_limits<std::int32_t>::max()) {
        throw UsageError{fmt::format("{} is {}, expected 0 or more", name, count)};
    }
    return static_cast<std::int32_t>(count);
}

} // namespace

SegmentFilter parse_road_filter(const Arguments& arguments) {
    SegmentFilter filter;
    if (const auto degrees = arguments.numbers("--bbox", 4)) {
        filter.box = box_of(*degrees);
    }
    filter.way_id = arguments.integer("--way");
    filter.name_part = arguments.value("--road").value_or("");
    filter.highway = arguments.value("--highway").value_or("");
    filter.period = parse_period(arguments);
    return filter;
}

SegmentFilter parse_filter(const Arguments& arguments) {
    auto filter = parse_road_filter(arguments);
    filter.with_state_only = !(arguments.has("--all") && arguments.flag("--all"));
    filter.class_name = arguments.value("--class").value_or("");
    filter.min_passes = parse_count(arguments, "--min-passes");
    filter.min_vehicles = parse_count(arguments, "--min-cars");
    filter.vehicle = arguments.value("--vehicle-id").value_or("");
    if (const auto file = arguments.value("--area")) {
        filter.area = std::make_shared<const Area>(read_area(*file));
    }
    return filter;
}

std::vector<std::filesystem::path> files_of_filter(const Arguments& arguments) {
    const auto file = arguments.value("--area");
    return file ? std::vector<std::filesystem::path>{*file} : std::vector<std::filesystem::path>{};
}

void complete_filter(SegmentFilter& filter, const StoreReader& store) {
    expect_known_class(filter, store);
    expect_known_highway(filter, store);
    if (!filter.vehicle.empty()) {
        filter.vehicle = car_named(store, filter.vehicle);
    }
}

bool selects_segments(const SegmentFilter& filter) {
    return filter.box || filter.area || filter.way_id || filter.key || !filter.name_part.empty() ||
           !filter.highway.empty() || !filter.class_name.empty();
}

void expect_whole_sections(const SegmentFilter& filter) {
    if (selects_segments(filter)) {
        throw UsageError{"--sections can be combined with --since, --until, --min-passes, "
                         "--min-cars and --vehicle-id only, not with options that select "
                         "segments"};
    }
}

bool selects(const SegmentFilter& filter) {
    return selects_segments(filter) || filter.min_passes > 0 || filter.min_vehicles > 0 ||
           !filter.vehicle.empty() || filter.period;
}

std::string text_of_filter(const Arguments& arguments, std::string_view but) {
    std::string text;
    for (const auto& option : selection_options) {
        const auto value = arguments.value(option.name);
        if (!value || option.name == but) {
            continue;
        }
        const auto shown = option.name == "--area" // no folder of the user in what is handed on
                               ? std::filesystem::path{*value}.filename().string()
                               : *value;
        const bool is_plain = shown.find_first_of(" \"'") == std::string::npos;
        text += fmt::format("{}{} {}",
                            text.empty() ? "" : " ",
                            option.name,
                            option.name == "--vehicle-id" ? "..."
                            : is_plain                    ? shown
                                                          : fmt::format("\"{}\"", shown));
    }
    return text;
}

} // namespace macadam
