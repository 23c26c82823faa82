#include "app/commands.hpp"
#include "app/segment_options.hpp"

#include "estimator/common/error.hpp"
#include "storage/export.hpp"
#include "storage/json.hpp"
#include "storage/utc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace macadam {
namespace {

constexpr double near_m = 50; // about the width of a road with its verges, and a fix's error

struct QueryOptions {
    std::filesystem::path store;
    SegmentFilter filter;
    std::optional<GeoPoint> near;
    double radius_m;
    std::string format;
    bool history;
};

QueryOptions parse_query(const Arguments& arguments) {
    constexpr std::array<std::string_view, 4> formats{"table", "json", "csv", "geojson"};
    QueryOptions options{.store = store_file(arguments),
                         .filter = parse_filter(arguments),
                         .near = {},
                         .radius_m = arguments.number("--radius", near_m),
                         .format = arguments.choice("--format", formats),
                         .history = arguments.flag("--history")};
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
    if (const auto worst = arguments.integer("--worst")) {
        if (*worst < 1) {
            throw UsageError{fmt::format("--worst is {}, expected at least 1", *worst)};
        }
        options.filter.worst = static_cast<std::size_t>(*worst);
    }
    const auto& filter = options.filter;
    if (!options.near && !filter.box && !filter.way_id && !filter.key && filter.name_part.empty() &&
        filter.worst == 0) {
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

std::string table_of(const std::vector<SegmentRecord>& records, const ClassTable& classes) {
    std::string table = fmt::format("{:<18} {:<24} {:>17} {:>6} {:>13}  {:<6} {:>6} {:>5}  {}\n",
                                    "segment",
                                    "road",
                                    "from-to m",
                                    "IRI",
                                    "90 %",
                                    "class",
                                    "passes",
                                    "cars",
                                    "last seen");
    for (const auto& record : records) {
        const auto& segment = record.segment;
        const auto road = record.name.empty() ? record.highway : record.name;
        table += fmt::format("{:<18} {:<24.24} {:>8.1f}-{:>8.1f}",
                             name_of(segment.key),
                             road,
                             segment.from_m,
                             segment.to_m);
        if (!record.state) {
            table += "      -             -  (nobody drove it yet)\n";
            continue;
        }
        const auto& state = *record.state;
        table += fmt::format(" {:>6.2f} {:>5.2f} - {:>5.2f}  {:<6} {:>6} {:>5}  {}\n",
                             state.iri_um / 1000.0,
                             state.low_um / 1000.0,
                             state.high_um / 1000.0,
                             classes.classes[class_index(classes, state.iri_um / 1000.0)].name,
                             state.passes,
                             state.vehicles,
                             state.last_seen_ms ? utc_text(*state.last_seen_ms).substr(0, 10)
                                                : "undated");
    }
    return table;
}

std::string json_object_of(const SegmentRecord& record, const ClassTable& classes) {
    JsonObject object;
    const auto values = field_values(record, classes);
    const auto fields = segment_fields();
    for (std::size_t i = 0; i < fields.size(); ++i) {
        if (!values[i]) {
            object.add(fields[i].name, nullptr);
        } else if (fields[i].type == Field::Type::text) {
            object.add(fields[i].name, *values[i]);
        } else {
            object.add(fields[i].name, JsonRaw{*values[i]});
        }
    }
    return object.text();
}

std::string json_of(const std::vector<SegmentRecord>& records, const ClassTable& classes) {
    std::vector<std::string> objects;
    objects.reserve(records.size());
    for (const auto& record : records) {
        objects.push_back(json_object_of(record, classes));
    }
    return json_array(objects) + "\n";
}

std::string csv_of(const std::vector<SegmentRecord>& records, const ClassTable& classes) {
    auto csv = csv_header() + "\n";
    for (const auto& record : records) {
        csv += csv_row(record, classes) + "\n";
    }
    return csv;
}

std::string geojson_of(const std::vector<SegmentRecord>& records, const ClassTable& classes) {
    std::vector<std::string> features;
    features.reserve(records.size());
    for (const auto& record : records) {
        features.push_back(geojson_feature(record, classes));
    }
    JsonObject collection;
    collection.add("type", std::string{"FeatureCollection"})
        .add("features", JsonRaw{json_array(features)});
    return collection.text() + "\n";
}

std::string history_table(const std::vector<PassRecord>& passes) {
    auto table = fmt::format("{:<22} {:<16} {:>6} {:>6} {:>7} {:>10}  {}\n",
                             "when",
                             "vehicle",
                             "IRI",
                             "sd",
                             "km/h",
                             "confidence",
                             "trip");
    for (const auto& record : passes) {
        const auto& pass = record.pass;
        table += fmt::format("{:<22} {:<16} {:>6.2f} {:>6.2f} {:>7.1f} {:>10.2f}  {:.12}\n",
                             record.utc_ms ? utc_text(*record.utc_ms / 1000 * 1000) : "undated",
                             record.vehicle,
                             pass.iri_um / 1000.0,
                             pass.sd_um / 1000.0,
                             pass.speed_mmps * 3.6e-3,
                             pass.confidence_ppm / 1e6,
                             record.trip_sha256);
    }
    return table;
}

std::string history_json(const std::vector<PassRecord>& passes) {
    const auto um = [](std::optional<IriUm> iri_um) {
        return iri_um ? json_number(*iri_um / 1000.0, 3) : JsonValue{nullptr};
    };
    std::vector<std::string> objects;
    for (const auto& record : passes) {
        const auto& pass = record.pass;
        JsonObject object;
        object.add("segment", name_of(pass.segment))
            .add("utc", record.utc_ms ? JsonValue{utc_text(*record.utc_ms)} : JsonValue{nullptr})
            .add("vehicle", record.vehicle)
            .add("iri", um(pass.iri_um))
            .add("iri_sd", um(pass.sd_um))
            .add("iri_left", um(pass.iri_left_um))
            .add("iri_right", um(pass.iri_right_um))
            .add("hri", um(pass.iri_centre_um))
            .add("speed_mps", JsonNumber{pass.speed_mmps / 1000.0, 3})
            .add("covered_m", JsonNumber{pass.covered_mm / 1000.0, 3})
            .add("confidence", JsonNumber{pass.confidence_ppm / 1e6, 3})
            .add("validity", name_of_validity(pass.validity))
            .add("trip", record.trip_sha256);
        objects.push_back(object.text());
    }
    return json_array(objects) + "\n";
}

void run_query(const Arguments& arguments, const Console& console) {
    const auto options = parse_query(arguments);
    const auto store = RoadStore::open(options.store, RoadStore::Access::read);
    warn_of_waiting(store, options.store, console);
    const auto& classes = *class_table(store.settings().class_table);

    const auto records = found_in(store, options);
    if (options.history) {
        const auto passes = store.history(*options.filter.key);
        print(options.format == "json" ? history_json(passes) : history_table(passes));
        return;
    }
    if (records.empty()) {
        console.say("nothing found: no segment with a pass meets these conditions (--all shows the "
                    "others)");
    }
    if (options.format == "json") {
        print(json_of(records, classes));
    } else if (options.format == "csv") {
        print(csv_of(records, classes));
    } else if (options.format == "geojson") {
        print(geojson_of(records, classes));
    } else if (!records.empty()) {
        print(table_of(records, classes));
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
    Option{"--worst", "N", "The N roughest of what the other options leave, the roughest first."},
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
             "first node, whatever the driving direction (+ in the key: forward, -: backward).",
    .example = "  macadam query roads.gpkg --worst 10\n"
               "  macadam query roads.gpkg --near 37.7258,-122.4720 --radius 100\n"
               "  macadam query roads.gpkg --way 123456 --format csv\n"
               "  macadam query roads.gpkg --segment 123456+0007 --history",
    .operands = operands,
    .options = options,
    .run = run_query};

} // namespace macadam
