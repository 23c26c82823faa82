#include "app/commands.hpp"
#include "app/output_guard.hpp"
#include "app/segment_options.hpp"

#include "storage/export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace macadam {
namespace {

struct ExportOptions {
    std::filesystem::path store;
    std::filesystem::path output;
    SegmentFilter filter;
};

ExportOptions parse_export(const Arguments& arguments) {
    const auto output = arguments.value("--output");
    if (!output) {
        throw UsageError{"-o FILE is missing"};
    }
    const auto suffixes = export_suffixes();
    if (std::ranges::none_of(suffixes, [&](auto suffix) { return output->ends_with(suffix); })) {
        throw UsageError{fmt::format(
            "-o is '{}', expected a name that ends in {}", *output, fmt::join(suffixes, ", "))};
    }
    return {.store = store_file(arguments), .output = *output, .filter = parse_filter(arguments)};
}

void run_export(const Arguments& arguments, const Console& console) {
    const auto options = parse_export(arguments);
    refuse_to_replace(options.output, {options.store});
    const auto store = RoadStore::open(options.store, RoadStore::Access::read);
    warn_of_waiting(store, options.store, console);
    const auto written =
        export_segments(store, options.filter, options.output, console.progress("writing"));
    console.say(fmt::format("{}: {}", options.output.string(), counted(written, "segment")));
}

constexpr std::array operands{store_operand};
constexpr std::array options{
    Option{"-o,--output",
           "FILE",
           "Where to; its suffix says what: .geojson, .geojsonl, .csv, .gpkg, "
           ".fgb."},
    bbox_option,
    way_option,
    name_option,
    all_option};

} // namespace

const Command export_command{
    .name = "export",
    .summary = "Hand the fused segments on: GeoJSON, CSV, GeoPackage, FlatGeobuf",
    .about = "One feature a segment and direction, its line in driving direction, with IRI, its 90 "
             "% interval,\n"
             "class, passes and linear reference (docs/outputs.md names every column). No trips, "
             "no cars.\n"
             "The file appears when it is whole.",
    .example = "  macadam export roads.gpkg -o roads.geojson\n"
               "  macadam export roads.gpkg -o north.csv --bbox 11.5,49.98,11.6,50.02",
    .operands = operands,
    .options = options,
    .run = run_export};

} // namespace macadam
