#include "app/commands.hpp"
#include "app/segment_options.hpp"
#include "app/segment_output.hpp"
#include "app/stretch_output.hpp"

#include "estimator/common/error.hpp"
#include "storage/network_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace macadam {
namespace {

constexpr double near_m = 50; // about the width of a road with its verges, and a fix's error

/// What --worst asks for.
struct WorstOptions {
    std::size_t count; ///< 0: nothing
    bool single_segments;
    std::optional<double> above_mm_per_m; ///< what is poor; nothing: by the store's classes
    double least_length_m;
};

WorstOptions parse_worst(const Arguments& arguments) {
    const auto count = arguments.integer("--worst");
    if (count && *count < 1) {
        throw UsageError{fmt::format("--worst is {}, expected at least 1", *count)};
    }
    for (const auto* name : {"--segments", "--above", "--min-length"}) {
        if (!count && arguments.flag(name)) {
            throw UsageError{fmt::format("{} goes with --worst N", name)};
        }
    }
    const WorstOptions options{
        .count = static_cast<std::size_t>(count.value_or(0)),
        .single_segments = arguments.flag("--segments"),
        .above_mm_per_m = arguments.number("--above"),
        .least_length_m = arguments.number("--min-length", RoadStretchConfig{}.least_length_m)};
    if (const auto above = options.above_mm_per_m; above && !(*above >= 0 && *above <= 100)) {
        throw UsageError{fmt::format("--above is {}, expected an IRI of 0 to 100 mm/m", *above)};
    }
    if (!(options.least_length_m >= 0)) {
        throw UsageError{
            fmt::format("--min-length is {}, expected 0 m or more", options.least_length_m)};
    }
    return options;
}

struct QueryOptions {
    std::filesystem::path store;
    SegmentFilter filter;
    std::optional<GeoPoint> near;
    double radius_m;
    std::string format;
    bool history;
    WorstOptions worst;
};

QueryOptions parse_query(const Arguments& arguments) {
    constexpr std::array<std::string_view, 4> formats{"table", "json", "csv", "geojson"};
    QueryOptions options{.store = store_file(arguments),
                         .filter = parse_filter(arguments),
                         .near = {},
                         .radius_m = arguments.number("--radius", near_m),
                         .format = arguments.choice("--format", formats),
                         .history = arguments.flag("--history"),
                         .worst = parse_worst(arguments)};
    if (arguments.flag("--json")) {
        options.format = "json";
    }
    if (const auto at = arguments.numbers("--near", 2)) {
        options.near = GeoPoint{(*at)[0], (*at)[1]};
        if (!(std::abs(options.near->lat_deg) <= 90 && std::abs(options.near->lon_deg) <= 180)) {
            throw UsageError{fmt::format("--near is {},{}, expected latitude,longitude in degrees",
                                         options.near->lat_deg,
                                         options.near->lon_deg)};
        }
        if (!(options.radius_m > 0 && options.radius_m <= 100000)) {
            throw UsageError{
                fmt::format("--radius is {}, expected 0 to 100000 m", options.radius_m)};
        }
    }
    if (const auto key = arguments.value("--segment")) {
        try {
            options.filter.key = parse_segment_key(*key);
        } catch (const InputError& error) {
            throw UsageError{fmt::format("--segment: {}", error.what())};
        }
    }
    if (options.worst.single_segments) {
        options.filter.worst = options.worst.count;
    }
    const auto& filter = options.filter;
    if (!options.near && !filter.box && !filter.way_id && !filter.key && filter.name_part.empty() &&
        options.worst.count == 0) {
        throw UsageError{
            "expected what to look for: --near, --bbox, --way, --segment, --name or --worst"};
    }
    if (options.history && !filter.key) {
        throw UsageError{"--history goes with --segment KEY"};
    }
    if (options.history && options.format != "table" && options.format != "json") {
        throw UsageError{
            fmt::format("--history has no --format {}, expected table or json", options.format)};
    }
    return options;
}

/// From a place to the nearest point of a line, m. Straight in degrees scaled to metres, which is
/// exact enough within the radius of a search.
double distance_to_line_m(const GeoPoint& place, const std::vector<GeoPoint>& line) {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const double along_m = distance_m(line[i], line[i + 1]);
        const double to_start_m = distance_m(line[i], place);
        const double to_end_m = distance_m(line[i + 1], place);
        // Law of cosines: how far along the piece the foot of the perpendicular lies.
        const double foot_m =
            along_m > 0 ? (to_start_m * to_start_m - to_end_m * to_end_m + along_m * along_m) /
                              (2 * along_m)
                        : 0;
        const auto foot =
            between(line[i], line[i + 1], along_m > 0 ? std::clamp(foot_m / along_m, 0.0, 1.0) : 0);
        nearest_m = std::min(nearest_m, distance_m(place, foot));
    }
    return nearest_m;
}

/// What two boxes share; with nothing the other.
GeoBox intersection(const std::optional<GeoBox>& a, const GeoBox& b) {
    return a ? GeoBox{std::max(a->west_deg, b.west_deg),
                      std::max(a->south_deg, b.south_deg),
                      std::min(a->east_deg, b.east_deg),
                      std::min(a->north_deg, b.north_deg)}
             : b;
}

std::vector<SegmentRecord>
nearest(std::vector<SegmentRecord> records, const GeoPoint& place, double radius_m) {
    std::vector<std::pair<double, SegmentRecord>> by_distance;
    for (auto& record : records) {
        const double apart_m = distance_to_line_m(place, record.segment.line);
        if (apart_m <= radius_m) {
            by_distance.emplace_back(apart_m, std::move(record));
        }
    }
    std::ranges::stable_sort(by_distance, {}, &std::pair<double, SegmentRecord>::first);
    std::vector<SegmentRecord> sorted;
    sorted.reserve(by_distance.size());
    for (auto& [apart_m, record] : by_distance) {
        sorted.push_back(std::move(record));
    }
    return sorted;
}

std::vector<SegmentRecord> found_in(const RoadStore& store, const QueryOptions& options) {
    auto filter = options.filter;
    if (options.near) {
        filter.box =
            intersection(filter.box, grown(including({}, *options.near), options.radius_m));
        filter.worst = 0; // of those within the radius, below
    }
    if (filter.key) {
        filter.with_state_only = false; // asked for by name, it is shown even if nobody drove it
    }
    std::vector<SegmentRecord> records;
    store.visit(filter, [&](const SegmentRecord& record) { records.push_back(record); });
    if (filter.key && records.empty()) {
        throw InputError{
            fmt::format("{}: has no segment '{}'", options.store.string(), name_of(*filter.key))};
    }
    if (options.near) {
        records = nearest(std::move(records), *options.near, options.radius_m);
    }
    if (options.near && options.filter.worst > 0) {
        std::ranges::stable_sort(records, std::ranges::greater{}, [](const SegmentRecord& record) {
            return record.state ? record.state->iri_um : -1;
        });
        records.resize(std::min(records.size(), options.filter.worst));
    }
    return records;
}

/// A table is for people, the other formats are for programs.
void print_in(const std::string& format, const std::string& text) {
    if (format == "table") {
        print_words(text);
    } else {
        print(text);
    }
}

void print_worst_stretches(const RoadStore& store,
                           const std::vector<SegmentRecord>& records,
                           const QueryOptions& options,
                           const Console& console) {
    const auto& classes = *class_table(store.settings().class_table);
    RoadStretchConfig config;
    config.above_mm_per_m = options.worst.above_mm_per_m.value_or(poor_above(classes));
    config.least_length_m = options.worst.least_length_m;
    auto stretches = worst_stretches(kept_roads(store), records, config);
    stretches.resize(std::min(stretches.size(), options.worst.count));
    if (stretches.empty()) {
        console.say(fmt::format(
            "nothing found: no stretch of {:g} m or more with a mean IRI above {:.2f} mm/m "
            "(--min-length and --above ask for less, --segments for single segments)",
            config.least_length_m,
            config.above_mm_per_m));
    }
    if (!stretches.empty() || options.format != "table") {
        print_in(options.format, stretches_text(stretches, options.format));
    }
}

void run_query(const Arguments& arguments, const Console& console) {
    const auto options = parse_query(arguments);
    const auto store = RoadStore::open(options.store, RoadStore::Access::read);
    warn_of_waiting(store, options.store, console);

    const auto records = found_in(store, options);
    if (options.history) {
        print_in(options.format, history_text(store.history(*options.filter.key), options.format));
        return;
    }
    if (options.worst.count > 0 && !options.worst.single_segments) {
        print_worst_stretches(store, records, options, console);
        return;
    }
    if (records.empty()) {
        console.say("nothing found: no segment with a pass meets these conditions (--all shows the "
                    "others)");
    }
    if (!records.empty() || options.format != "table") {
        print_in(
            options.format,
            segments_text(records, *class_table(store.settings().class_table), options.format));
    }
}

constexpr std::array operands{store_operand};
constexpr std::array options{
    Option{"--near", "LAT,LON", "Segments near a place, the nearest first."},
    Option{"--radius", "METRES", "How near.", "50"},
    bbox_option,
    way_option,
    Option{"--segment", "KEY", "One segment, such as 123456+0007."},
    name_option,
    Option{"--worst",
           "N",
           "The N roughest stretches of what the other options leave, the roughest first."},
    Option{"--min-length", "METRES", "With --worst: leave out shorter stretches.", "100"},
    Option{
        "--above", "IRI", "With --worst: what is poor, in mm/m.", "above the store's middle class"},
    Option{"--segments", "", "With --worst: single segments, not stretches."},
    all_option,
    Option{
        "--history", "", "With --segment: every pass over it instead of what they say together."},
    Option{"--format", "NAME", "table, json, csv or geojson.", "table"},
    Option{"--json", "", "The same as --format json."}};

} // namespace

const Command query_command{
    .name = "query",
    .summary = "Ask a store: near a place, in a box, along a way, the worst",
    .about = "Conditions add up. IRI is in mm/m, with its 90 % interval; from-to is metres along "
             "the way from its\n"
             "first node, whatever the driving direction (+ in the key: forward, -: backward). "
             "--worst joins poor\n"
             "segments that follow each other on one road to stretches.",
    .example = "  macadam query roads.gpkg --worst 10\n"
               "  macadam query roads.gpkg --near 37.7258,-122.4720 --radius 100\n"
               "  macadam query roads.gpkg --way 123456 --format csv\n"
               "  macadam query roads.gpkg --segment 123456+0007 --history",
    .operands = operands,
    .options = options,
    .run = run_query};

} // namespace macadam
