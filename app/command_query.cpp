#include "app/audit_output.hpp"
#include "app/commands.hpp"
#include "app/month_history.hpp"
#include "app/near_search.hpp"
#include "app/period_options.hpp"
#include "app/publication_words.hpp"
#include "app/query_options.hpp"
#include "app/section_output.hpp"
#include "app/segment_options.hpp"
#include "app/segment_output.hpp"
#include "app/store_patience.hpp"
#include "app/stretch_output.hpp"

#include "estimator/common/error.hpp"
#include "storage/network_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace macadam {
namespace {

/// Asked for by name, a segment is shown even if nobody drove it.
SegmentFilter filter_of(const QueryOptions& options) {
    auto filter = options.filter;
    filter.with_state_only = filter.with_state_only && !filter.key;
    return filter;
}

void expect_segment(const RoadStore& store, const QueryOptions& options) {
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

std::vector<SegmentRecord> found_in(const RoadStore& store,
                                    const SegmentFilter& filter,
                                    const std::optional<NearOptions>& near) {
    if (near) {
        return segments_near(store, filter, *near);
    }
    std::vector<SegmentRecord> records;
    store.visit(filter, [&](const SegmentRecord& record) { records.push_back(record); });
    return records;
}

void print_worst_stretches(const RoadStore& store,
                           const std::vector<SegmentRecord>& records,
                           const QueryOptions& options,
                           const Console& console) {
    const auto& classes = *class_table(store.settings().class_table);
    RoadStretchConfig config;
    config.above_mm_per_m = options.worst.above_mm_per_m.value_or(poor_above(classes));
    config.least_length_m = options.worst.least_length_m;
    auto stretches = worst_stretches(
        kept_roads(store, [&](const std::string& words) { console.say(words); }), records, config);
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

void print_history(const RoadStore& store, const QueryOptions& options, const Console& console) {
    auto filter = options.filter;
    filter.with_state_only = true;
    const auto found = [&](const Period& period) {
        const bool whole = !period.from_ms && !period.until_ms;
        filter.period = whole ? std::nullopt : std::optional{period};
        return found_in(store, filter, options.near);
    };
    const auto months = history_by_month(found, options.filter.period.value_or(Period{}));
    if (months.empty()) {
        console.say("nothing found: no segment that meets these conditions has a pass with a date");
    }
    if (!months.empty() || options.format != "table") {
        print_in(options.format, months_text(months, options.format));
    }
}

void print_segments(const RoadStore& store, const QueryOptions& options, const Console& console) {
    SegmentPrinter printer{options.format, *class_table(store.settings().class_table)};
    if (options.near) {
        for (const auto& record : segments_near(store, filter_of(options), *options.near)) {
            printer.add(record);
        }
    } else {
        store.visit(filter_of(options), [&](const SegmentRecord& record) { printer.add(record); });
    }
    printer.finish();
    if (printer.count() == 0) {
        console.say("nothing found: no segment with a pass meets these conditions (--all shows the "
                    "others)");
    }
}

void print_sections(const RoadStore& store, const QueryOptions& options, const Console& console) {
    SectionWriter writer{options.format,
                         *class_table(store.settings().class_table),
                         [&](std::string_view text) { print_in(options.format, text); }};
    const auto total =
        each_section(store, *options.sections, options.filter, [&](const NamedSection& section) {
            writer.add(section);
        });
    writer.finish();
    console.say(spoken(total));
}

void run_query(const Arguments& arguments, const Console& console) {
    const auto options = parse_query(arguments);
    const auto store = open_for_operator(options.store, console);
    expect_known_class(options.filter, store);
    warn_of_waiting(store, options.store, console);
    expect_segment(store, options);

    if (options.sections) {
        print_sections(store, options, console);
    } else if (options.passes) {
        expect_operator(store, "single passes");
        print_in(options.format, passes_text(store.history(*options.filter.key), options.format));
    } else if (options.changes) {
        expect_operator(store, "changes of numbers");
        print_in(options.format, changes_text(store.changes(*options.filter.key), options.format));
    } else if (options.history) {
        print_history(store, options, console);
    } else if (options.worst.count > 0 && !options.worst.single_segments) {
        print_worst_stretches(
            store, found_in(store, options.filter, options.near), options, console);
    } else {
        print_segments(store, options, console);
    }
    store.expect_in_place();
}

constexpr std::array operands{store_operand};
constexpr std::array options{
    Option{"--near", "LAT,LON", "Segments near a place, the nearest first."},
    Option{"--radius", "METRES", "How near.", "50"},
    Option{"--heading",
           "DEG",
           "With --near: only the direction driven so, within 45 degrees; clockwise from north."},
    bbox_option,
    way_option,
    Option{"--segment", "KEY", "One segment, such as 123456+0007."},
    name_option,
    highway_option,
    class_option,
    least_passes_option,
    since_option,
    until_option,
    Option{"--worst",
           "N",
           "The N roughest stretches of what the other options leave, the roughest first."},
    Option{"--min-length", "METRES", "With --worst: leave out shorter stretches.", "100"},
    Option{
        "--above", "IRI", "With --worst: what is poor, in mm/m.", "above the store's middle class"},
    Option{"--segments", "", "With --worst: single segments, not stretches."},
    Option{"--route",
           "LAT,LON LAT,LON",
           "The quickest way by car from one place to another, as a profile in sections.",
           "",
           true},
    Option{"--shortest", "", "With --route: the shortest way."},
    Option{"--along",
           "FILE",
           "The roads that a GPX track or a layer of lines follows, as a profile in sections."},
    sections_option,
    section_length_option,
    homogeneous_option,
    exclude_option,
    exclude_radius_option,
    all_option,
    Option{"--history", "", "Month by month: what the passes of each say of all that is found."},
    Option{"--passes", "", "With --segment: every pass over it, one by one."},
    Option{"--changes", "", "With --segment: when its number changed, and why."},
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
             "segments that follow each other on one road to stretches. --since and --until leave "
             "passes of other\ntimes, and those without a date, out of every number. --route, "
             "--along and --sections give means over\nsections of roads (docs/sections.md).",
    .example =
        "  macadam query roads.gpkg --worst 10\n"
        "  macadam query roads.gpkg --near 37.7258,-122.4720 --radius 100\n"
        "  macadam query roads.gpkg --way 123456 --format csv\n"
        "  macadam query roads.gpkg --name haupt --history         is it getting worse?\n"
        "  macadam query roads.gpkg --route 47.6863,17.6799 47.6901,17.7012\n"
        "  macadam query roads.gpkg --sections routes.csv --section-length 0.1mi --format csv\n"
        "  macadam query roads.gpkg --segment 123456+0007 --passes",
    .operands = operands,
    .options = options,
    .run = run_query};

} // namespace macadam
