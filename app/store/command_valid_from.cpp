#include "app/cli/commands.hpp"
#include "app/cli/overwrite_guard.hpp"
#include "app/cli/row_output.hpp"
#include "app/cli/row_writer.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "app/database/period_options.hpp"
#include "app/database/segment_options.hpp"
#include "app/database/server_store.hpp"

#include "estimator/common/error.hpp"
#include "storage/text/columns.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <array>

namespace macadam {
namespace {

// clang-format off
const Columns<ValidSince> list_columns{
    {"segment", as::text, [](auto& r) { return name_of(r.segment); }, {"segment", "{:<24}"}},
    {"valid_from", as::text, [](auto& r) { return utc_text(r.from_ms); }, {"valid from", " {}"}},
};
// clang-format on

void print_list(const StoreReader& store, const Arguments& arguments) {
    const auto all = store.valid_since();
    const auto format = row_format_of(arguments);
    RowOutput output{arguments.value("--output")};
    print(all.empty() && format == "table" ? "no segment has a start date: all passes count\n"
                                           : rows_text(list_columns, all, format));
    output.commit();
}

/// Returns all segments that the options name, driven or not.
std::vector<SegmentKey> segments_named(const StoreReader& store, const Arguments& arguments) {
    SegmentFilter filter;
    filter.with_state_only = false;
    filter.key = parse_key(arguments);
    filter.way_id = arguments.integer("--way");
    filter.name_part = arguments.value("--road").value_or("");
    filter.highway = arguments.value("--highway").value_or("");
    if (const auto degrees = arguments.numbers("--bbox", 4)) {
        filter.box = box_of(*degrees);
    }
    if (!filter.key && !filter.way_id && !filter.box && filter.name_part.empty() &&
        filter.highway.empty()) {
        throw UsageError{"expected a selection of roads: --segment, --way, --road, --highway "
                         "or --bbox"};
    }
    expect_known_highway(filter, store);
    std::vector<SegmentKey> keys;
    store.visit(filter, [&](const SegmentRecord& record) { keys.push_back(record.segment.key); });
    if (keys.empty()) {
        throw InputError{
            fmt::format("{}: has no segment that meets these conditions", store.file().string())};
    }
    return keys;
}

void run_valid_from(const Arguments& arguments, const Console& console) {
    const auto file = file_or_server(arguments);
    if (const auto output = row_file_of(arguments)) {
        refuse_to_replace(*output, {file});
    }
    const auto from_ms = parse_begin(arguments, "--since");
    const bool readmit = arguments.flag("--any-day");
    if (from_ms && readmit) {
        throw UsageError{"--since and --any-day cannot be combined"};
    }
    for (const auto* const option : {"--output", "--format"}) {
        if ((from_ms || readmit) && arguments.value(option)) {
            throw UsageError{
                fmt::format("{} belongs to the list of start dates, which is printed without "
                            "--since and --any-day",
                            option)};
        }
    }
    if (!from_ms && !readmit) {
        print_list(opened_reader(file, console), arguments);
        return;
    }
    auto store = opened_store(file, console);
    const auto segments = segments_named(store, arguments);
    const auto progress = console.progress("fusing");
    const auto found = store.maintenance.set_valid_from(
        segments, from_ms, arguments.value("--reason").value_or(""), progress);
    console.say(from_ms ? fmt::format("{}: only passes from {} on count",
                                      counted(found, "segment"),
                                      utc_text(*from_ms))
                        : fmt::format("{}: all passes count", counted(found, "segment")));
}

constexpr std::array operands{import_operand};
constexpr std::array options{
    formerly("--from", {"--since", "TIME", "Start date: 2026-05-01, or a time in UTC."}),
    Option{"--any-day", "", "Clear the start date."},
    in_group("selection", {"--segment", "KEY", "One segment, such as 123456+0007."}),
    way_option,
    road_option,
    highway_option,
    bbox_option,
    Option{"--reason", "TEXT", "Reason for the audit: 'resurfaced, contract 17'."},
    one_of("table|csv|json", {"--format", "NAME", "Of the list: table, csv or json.", "table"}),
    row_output_option,
    json_option};

} // namespace

const Command valid_from_command{
    .name = "valid-from",
    .summary = "Ignore data from before a resurfacing",
    .about = "Passes before the start date, and undated ones, no longer count for these "
             "segments; they stay in the\n"
             "database, and --any-day re-admits them. Both directions are selected unless "
             "--segment names one. Without\n"
             "--since and --any-day: lists the segments with a start date. Most resurfacings "
             "are detected automatically\n"
             "(column 'changed'), but only after some passes.",
    .example = "  macadam valid-from roads.gpkg --since 2026-05-01 --way 123456 --reason "
               "'resurfaced'\n"
               "  macadam valid-from roads.gpkg --any-day --way 123456\n"
               "  macadam valid-from roads.gpkg",
    .operands = operands,
    .options = options,
    .run = run_valid_from};

} // namespace macadam
