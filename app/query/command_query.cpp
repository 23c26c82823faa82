#include "app/cli/commands.hpp"
#include "app/cli/joined_options.hpp"
#include "app/cli/overwrite_guard.hpp"
#include "app/cli/row_output.hpp"
#include "app/database/empty_map_message.hpp"
#include "app/database/publication_messages.hpp"
#include "app/database/selection.hpp"
#include "app/database/server_store.hpp"
#include "app/output/excel_option.hpp"
#include "app/output/units_option.hpp"
#include "app/query/audit_output.hpp"
#include "app/query/monthly_history.hpp"
#include "app/query/nearest_segments.hpp"
#include "app/query/pass_output.hpp"
#include "app/query/query_options.hpp"
#include "app/query/section_output.hpp"
#include "app/query/worst_sections_output.hpp"

#include "estimator/common/error.hpp"
#include "storage/exports/event_export.hpp"
#include "storage/exports/export.hpp"
#include "storage/networks/network_file.hpp"
#include "storage/store/reader/pass_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>

namespace macadam {
namespace {

/// Returns the filter; a segment requested by key is shown even without passes.
SegmentFilter filter_of(const QueryOptions& options) {
    auto filter = options.filter;
    filter.with_state_only = filter.with_state_only && !filter.key;
    return filter;
}

/// Returns one range for each segment.
std::vector<SegmentRange> ranges_of(const std::vector<SegmentRecord>& records) {
    std::vector<SegmentRange> ranges;
    for (const auto& record : records) {
        const auto& [way_id, forward, index] = record.segment.key;
        ranges.push_back({way_id, forward, index, index + 1});
    }
    return ranges;
}

void expect_segment(const StoreReader& store, const QueryOptions& options) {
    SegmentFilter filter;
    filter.key = options.filter.key;
    filter.with_state_only = false;
    bool known = !filter.key;
    if (filter.key) {
        store.visit(filter, [&](const SegmentRecord&) { known = true; });
    }
    if (!known) {
        throw InputError{
            fmt::format("{}: has no segment '{}'", options.store.string(), name_of(*filter.key))};
    }
}

std::vector<SegmentRecord> found_in(const StoreReader& store,
                                    const SegmentFilter& filter,
                                    const std::optional<NearOptions>& near) {
    if (near) {
        return segments_near(store, filter, *near);
    }
    std::vector<SegmentRecord> records;
    store.visit(filter, [&](const SegmentRecord& record) { records.push_back(record); });
    return records;
}

/// Returns a function that prints results: a table for people, the other formats for programs.
std::function<void(std::string_view)> printer_of(const QueryOptions& options) {
    if (options.format == "table") {
        return print_words;
    }
    if (options.excel) {
        return [excel = std::make_shared<ExcelCsv>(*options.excel)](std::string_view csv) {
            print((*excel)(csv));
        };
    }
    return print;
}

void print_worst_sections(const StoreReader& store,
                          const std::vector<SegmentRecord>& records,
                          const QueryOptions& options,
                          const Console& console) {
    const auto& classes = *class_table(store.settings().class_table);
    WorstSectionConfig config;
    config.above_mm_per_m = options.worst.above_mm_per_m.value_or(poor_above(classes));
    config.min_length_m = options.worst.min_length_m;
    auto stretches = worst_sections(
        load_or_build_network(store, [&](const std::string& words) { console.say(words); }),
        records,
        config);
    stretches.resize(std::min(stretches.size(), options.worst.count));
    if (stretches.empty()) {
        console.say(
            fmt::format("no section of {} or more has a mean IRI above {}; lower --min-length "
                        "or --above, or list single segments with --segments",
                        length_words(config.min_length_m, options.units),
                        iri_words(config.above_mm_per_m, options.units)));
        warn_of_empty_map(store, console);
    }
    if (!stretches.empty() || options.format != "table") {
        printer_of(options)(stretches_text(stretches, options.format, options.units));
    }
}

void print_history(const StoreReader& store, const QueryOptions& options, const Console& console) {
    auto filter = options.filter;
    filter.with_state_only = true;
    const auto found = [&](const Period& period) {
        const bool whole = !period.from_ms && !period.until_ms;
        filter.period = whole ? std::nullopt : std::optional{period};
        return found_in(store, filter, options.near);
    };
    const auto months = history_by_month(found, options.filter.period.value_or(Period{}));
    if (months.empty()) {
        console.say("no segment that meets these conditions has a dated pass");
        warn_of_empty_map(store, console);
    }
    if (!months.empty() || options.format != "table") {
        printer_of(options)(months_text(months, options.format, options.units));
    }
}

void print_segments(const StoreReader& store, const QueryOptions& options, const Console& console) {
    const auto& classes = *class_table(store.settings().class_table);
    const auto columns = in_units(segment_columns(), options.units);
    RowWriter<ClassedSegment> printer{
        options.format, columns, printer_of(options), [&](const ClassedSegment& segment) {
            return geojson_feature(segment, columns);
        }};
    const auto add = [&](const SegmentRecord& record) { printer.add({record, classes}); };
    if (options.near) {
        std::ranges::for_each(segments_near(store, filter_of(options), *options.near), add);
    } else {
        store.visit(filter_of(options), add);
    }
    printer.finish();
    if (printer.count() == 0) {
        console.say("no segment with a pass meets these conditions; --all also shows segments "
                    "without a pass");
        warn_of_empty_map(store, console);
    }
}

bool is_near(const EventRecord& record, const NearOptions& near) {
    return distance_m(record.at, near.at) <= near.radius_m;
}

void print_events(const StoreReader& store, const QueryOptions& options, const Console& console) {
    auto filter = filter_of(options);
    if (options.near) {
        filter.ranges = ranges_of(segments_near(store, filter, *options.near));
    }
    auto events = store.events(filter);
    if (options.near) {
        std::erase_if(events, [&](const auto& event) { return !is_near(event, *options.near); });
    }
    if (events.empty()) {
        console.say(
            store.shows_published_alone()
                ? "no pothole, bump, joint or rail of at least five cars is published there"
                : "no pothole, bump, joint or rail was reported by two passes or more there");
        warn_of_empty_map(store, console);
    }
    const auto columns = in_units(event_fields(), options.units);
    if (!events.empty() || options.format != "table") {
        printer_of(options)(
            rows_text(columns, events, options.format, [&](const EventRecord& event) {
                return geojson_feature(event.at, json_object(columns, event));
            }));
    }
}

void print_sections(const StoreReader& store, const QueryOptions& options, const Console& console) {
    const auto& classes = *class_table(store.settings().class_table);
    auto [columns, writer] = section_writer(options.format, printer_of(options), options.units);
    const auto total = each_section(store,
                                    *options.sections,
                                    options.filter,
                                    [&classes, &writer = writer](const NamedSection& section) {
                                        writer.add({section, classes});
                                    });
    writer.begin(); // a table without sections has headings, too
    writer.finish();
    console.say(spoken(total, options.units));
}

/// Returns what a query reads of a database on a server. Sections, and roads that consist of
/// several ways, need all roads.
ServerNeed need_of(const QueryOptions& options) {
    ServerNeed need;
    need.content.background = false;
    need.content.passes = options.history || options.passes || options.changes || options.events ||
                          selects_passes(options.filter);
    const bool joins = options.worst.count > 0 && !options.worst.single_segments;
    if (!options.sections && !joins && options.filter.vehicle.empty()) {
        need.segments = filter_of(options);
        if (options.near) {
            need.segments->worst = 0;
            need.segments->box = box_near(options.filter, *options.near);
        }
    }
    return need;
}

void run_query(const Arguments& arguments, const Console& console) {
    auto options = parse_query(arguments);
    if (options.output) {
        auto inputs = files_of_filter(arguments);
        inputs.push_back(options.store);
        if (const auto& of = options.sections) {
            for (const auto& file : {of->along, of->sections, of->exclude}) {
                inputs.insert(inputs.end(), file.value_or(options.store));
            }
        }
        refuse_to_replace(*options.output, inputs);
    }
    const auto store = open_for_operator(options.store, console, need_of(options));
    complete_filter(options.filter, store);
    warn_of_waiting(store, options.store, console);
    expect_segment(store, options);

    RowOutput output{options.output};
    if (options.sections) {
        print_sections(store, options, console);
    } else if (options.events) {
        print_events(store, options, console);
    } else if (options.passes) {
        expect_operator(store, "single passes");
        printer_of(options)(
            passes_text(store.history(*options.filter.key), options.format, options.units));
    } else if (options.changes) {
        expect_operator(store, "changes of values");
        printer_of(options)(
            changes_text(store.changes(*options.filter.key), options.format, options.units));
    } else if (options.history) {
        print_history(store, options, console);
    } else if (options.worst.count > 0 && !options.worst.single_segments) {
        print_worst_sections(
            store, found_in(store, options.filter, options.near), options, console);
    } else {
        print_segments(store, options, console);
    }
    store.expect_in_place();
    output.commit();
}

constexpr std::array operands{source_operand};
constexpr std::array near_options{
    in_group("selection", {"--near", "LAT,LON", "Segments near a point, nearest first."}),
    in_group("selection", {"--radius", "METRES", "Search radius around --near.", "50"}),
    in_group("selection",
             {"--heading",
              "DEG",
              "With --near: only segments with this driving direction, within 45 degrees; "
              "clockwise from north."}),
    in_group("selection", {"--segment", "KEY", "One segment, such as 123456+0007."})};
constexpr std::array row_options{
    in_group(
        "worst sections",
        {"--worst", "N", "The N roughest sections among the selected segments, roughest first."}),
    in_group("worst sections",
             {"--min-length", "METRES", "With --worst: minimum length of a section.", "100"}),
    in_group("worst sections",
             {"--above",
              "IRI",
              "With --worst: roughness threshold in mm/m, whatever the --units.",
              "lower limit of class "
              "poor"}),
    in_group("worst sections",
             {"--segments", "", "With --worst: single segments instead of sections."}),
    in_group("sections",
             {"--route",
              "LAT,LON LAT,LON",
              "Sections along the fastest route by car between two points.",
              "",
              true}),
    in_group("sections", {"--shortest", "", "With --route: the shortest route instead."}),
    in_group("sections", {"--along", "FILE", "Sections along a GPX track or a layer of lines."}),
    sections_option,
    section_length_option,
    homogeneous_option,
    exclude_option,
    exclude_radius_option,
    all_option,
    Option{"--history", "", "Monthly values of everything that is selected."},
    Option{"--passes", "", "With --segment: list every pass over it."},
    Option{"--changes", "", "With --segment: when and why its value changed."},
    Option{"--events", "", "Potholes, bumps, joints and rails instead of segments."},
    one_of("table|json|csv|geojson", {"--format", "NAME", "table, json, csv or geojson.", "table"}),
    row_output_option,
    json_option,
    units_option,
    excel_option};
constexpr auto options = joined(near_options, selection_options, row_options);

} // namespace

const Command query_command{
    .name = "query",
    .summary = "Query the database: near a point, in a box, along a way, worst sections",
    .about = "Conditions are combined (AND). IRI is in mm/m, with its 90 % interval; from-to "
             "is metres along the way\n"
             "from its first node, whatever the driving direction (+ in the key: forward, -: "
             "backward). --worst joins\n"
             "consecutive poor segments of a road into sections. --since and --until exclude "
             "passes at other times\n"
             "and undated ones from all values. --route, --along and --sections give means "
             "over road sections\n"
             "(docs/reference/sections.md).",
    .example =
        "  macadam query roads.gpkg --worst 10\n"
        "  macadam query roads.gpkg --near 37.7258,-122.4720 --radius 100\n"
        "  macadam query roads.gpkg --way 123456 --format csv\n"
        "  macadam query roads.gpkg --road haupt --history         is it getting worse?\n"
        "  macadam query roads.gpkg --route 47.6863,17.6799 47.6901,17.7012\n"
        "  macadam query roads.gpkg --sections routes.csv --section-length 0.1mi --format csv\n"
        "  macadam query roads.gpkg --segment 123456+0007 --passes\n"
        "  macadam query roads.gpkg --events --road haupt --format csv",
    .operands = operands,
    .options = options,
    .run = run_query};

} // namespace macadam
