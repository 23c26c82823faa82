#include "app/query/query_options.hpp"

#include "app/cli/row_output.hpp"
#include "app/database/selection.hpp"
#include "app/database/server_store.hpp"
#include "app/output/excel_option.hpp"
#include "app/output/units_option.hpp"

#include "mapping/analysis/worst_sections.hpp"

#include <fmt/format.h>

#include <cmath>

namespace macadam {
namespace {

constexpr double near_m = 50; // about the width of a road with its verges, plus the error of a fix

WorstOptions parse_worst(const Arguments& arguments) {
    const auto count = arguments.integer("--worst");
    if (count && *count < 1) {
        throw UsageError{fmt::format("--worst is {}, expected at least 1", *count)};
    }
    for (const auto* name : {"--segments", "--above", "--min-length"}) {
        if (!count && arguments.flag(name)) {
            throw UsageError{fmt::format("{} requires --worst N", name)};
        }
    }
    const WorstOptions options{
        .count = static_cast<std::size_t>(count.value_or(0)),
        .single_segments = arguments.flag("--segments"),
        .above_mm_per_m = arguments.number("--above"),
        .min_length_m = arguments.number("--min-length", WorstSectionConfig{}.min_length_m)};
    if (const auto above = options.above_mm_per_m; above && !(*above >= 0 && *above <= 100)) {
        throw UsageError{fmt::format("--above is {}, expected an IRI of 0 to 100 mm/m", *above)};
    }
    if (!(options.min_length_m >= 0)) {
        throw UsageError{
            fmt::format("--min-length is {}, expected 0 m or more", options.min_length_m)};
    }
    return options;
}

std::optional<NearOptions> parse_near(const Arguments& arguments) {
    const auto at = arguments.numbers("--near", 2);
    if (!at) {
        if (arguments.flag("--heading")) {
            throw UsageError{"--heading requires --near LAT,LON"};
        }
        return std::nullopt;
    }
    const NearOptions near{.at = parse_place("--near", *at),
                           .radius_m = arguments.number("--radius", near_m),
                           .heading_deg = arguments.number("--heading")};
    if (!(near.radius_m > 0 && near.radius_m <= 100000)) {
        throw UsageError{fmt::format("--radius is {}, expected 0 to 100000 m", near.radius_m)};
    }
    if (near.heading_deg && !(*near.heading_deg >= 0 && *near.heading_deg <= 360)) {
        throw UsageError{fmt::format("--heading is {}, expected 0 to 360 degrees clockwise from "
                                     "north",
                                     *near.heading_deg)};
    }
    return near;
}

bool asks_for_segments(const QueryOptions& options) {
    return options.near || selects_segments(options.filter) || options.worst.count > 0;
}

/// Rejects other filters: sections are reported completely.
void expect_sections_alone(const QueryOptions& options) {
    if (asks_for_segments(options) || !options.filter.with_state_only || options.history ||
        options.passes || options.changes || options.events) {
        throw UsageError{"--route, --along and --sections can be combined with --since, --until, "
                         "--min-passes, --min-cars and --vehicle-id only, not with options that "
                         "select segments"};
    }
}

/// Rejects invalid combinations.
void expect_sense(const QueryOptions& options) {
    if (options.sections) {
        expect_sections_alone(options);
        return;
    }
    if (options.events && (options.passes || options.history || options.changes ||
                           options.worst.count > 0 || !options.filter.with_state_only)) {
        throw UsageError{"--events cannot be combined with --passes, --history, --changes, "
                         "--worst or --all"};
    }
    if (!asks_for_segments(options) && !options.events && options.filter.vehicle.empty()) {
        throw UsageError{"expected a selection: --near, --bbox, --area, --way, --segment, --road, "
                         "--highway, --class, --vehicle-id, --worst, --route, --along or "
                         "--sections"};
    }
    if (options.passes && !options.filter.key) {
        throw UsageError{"--passes requires --segment KEY"};
    }
    if (options.passes && options.filter.period) {
        throw UsageError{"--passes lists all passes and cannot be combined with --since or "
                         "--until"};
    }
    if (options.passes) {
        auto others = options.filter;
        others.key.reset();
        if (selects(others) || options.near) {
            throw UsageError{"--passes requires --segment KEY and no other selection"};
        }
    }
    if (options.changes) {
        auto others = options.filter;
        others.key.reset();
        others.period.reset(); // refused below
        if (options.filter.key && (selects(others) || options.near)) {
            throw UsageError{"--changes requires --segment KEY and no other selection"};
        }
    }
    if (options.changes && (!options.filter.key || options.passes || options.history ||
                            options.filter.period || options.format == "geojson")) {
        throw UsageError{"--changes requires --segment KEY and no other selection, as table, "
                         "json or csv"};
    }
    if (options.history && (options.passes || options.worst.count > 0)) {
        throw UsageError{fmt::format("--history cannot be combined with {}",
                                     options.passes ? "--passes" : "--worst")};
    }
    if ((options.passes || options.history) && options.format == "geojson") {
        throw UsageError{fmt::format("{} has no --format geojson, expected table, json or csv",
                                     options.passes ? "--passes" : "--history")};
    }
}

} // namespace

GeoPoint parse_place(std::string_view name, const std::vector<double>& degrees) {
    const GeoPoint place{degrees[0], degrees[1]};
    if (!(std::abs(place.lat_deg) <= 90 && std::abs(place.lon_deg) <= 180)) {
        throw UsageError{fmt::format("{} is {},{}, expected latitude,longitude in degrees",
                                     name,
                                     place.lat_deg,
                                     place.lon_deg)};
    }
    return place;
}

QueryOptions parse_query(const Arguments& arguments) {
    QueryOptions options{.store = file_or_server(arguments),
                         .filter = parse_filter(arguments),
                         .near = parse_near(arguments),
                         .sections = parse_sections(arguments, true),
                         .format = row_format_of(arguments),
                         .output = row_file_of(arguments),
                         .history = arguments.flag("--history"),
                         .passes = arguments.flag("--passes"),
                         .changes = arguments.flag("--changes"),
                         .events = arguments.flag("--events"),
                         .worst = parse_worst(arguments),
                         .units = parse_units(arguments),
                         .excel = parse_excel(arguments)};
    if (options.excel && options.format != "csv") {
        throw UsageError{"--excel requires --format csv or -o FILE.csv"};
    }
    options.filter.key = parse_key(arguments);
    expect_sense(options);
    if (options.worst.single_segments) {
        options.filter.worst = options.worst.count;
    }
    return options;
}

} // namespace macadam
