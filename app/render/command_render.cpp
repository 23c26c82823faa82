#include "app/cli/commands.hpp"
#include "app/cli/joined_options.hpp"
#include "app/cli/overwrite_guard.hpp"
#include "app/database/empty_map_message.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "app/database/publication_messages.hpp"
#include "app/database/selection.hpp"
#include "app/database/server_store.hpp"
#include "app/output/units_option.hpp"
#include "app/render/base_map_option.hpp"
#include "app/render/change_map.hpp"
#include "app/render/knowledge_map.hpp"
#include "app/render/map_scene.hpp"
#include "app/render/picture_output.hpp"
#include "app/render/style_options.hpp"

#include "estimator/common/error.hpp"
#include "mapping/geometry/antimeridian.hpp"
#include "storage/store/reader/pass_choice.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace macadam {
namespace {

struct RenderOptions {
    std::filesystem::path store;
    PictureOutput output;
    SegmentFilter filter;
    std::string selection; ///< in words
    std::string title;
    MapStyle style;
    std::optional<BaseMapChoice> base;
    bool events;
    bool background;
    std::optional<std::int64_t> since_ms; ///< changes since then instead of roughness
    std::optional<Knowledge> knowledge;   ///< instead of roughness
};

/// Parses --compare-since. The map of changes has classes and colours of its own.
std::optional<std::int64_t> parse_change(const Arguments& arguments) {
    const auto since_ms = parse_begin(arguments, "--compare-since");
    for (const auto* const option : {"--classes", "--ramp", "--grey-below", "--class"}) {
        if (since_ms && arguments.is_given(option)) {
            throw UsageError{fmt::format("--compare-since and {} cannot be combined", option)};
        }
    }
    return since_ms;
}

std::string usual_title(const Arguments& arguments) {
    const auto kind = arguments.choice("--colour-by");
    return arguments.value("--compare-since") ? "Change of road roughness"
           : kind == "passes"                 ? "Coverage of roads"
           : kind == "age"                    ? "Age of measurements"
           : kind == "confidence"             ? "Confidence of road roughness"
                                              : "Road roughness";
}

RenderOptions parse_render(const Arguments& arguments, const Console& console) {
    return {.store = file_or_server(arguments),
            .output = parse_picture_output(arguments),
            .filter = parse_filter(arguments),
            .selection = text_of_filter(arguments, "--bbox"),
            .title = arguments.value("--title").value_or(usual_title(arguments)),
            .style = parse_style(arguments, console),
            .base = parse_base_map(arguments),
            .events = arguments.flag("--events"),
            .background = !arguments.flag("--no-background"),
            .since_ms = parse_change(arguments),
            .knowledge = parse_colour_by(arguments)};
}

/// Checks that no input is overwritten and that the base map is not the road database.
void expect_files_apart(const RenderOptions& options, const Arguments& arguments) {
    auto inputs = files_of_filter(arguments);
    inputs.push_back(options.store);
    if (options.base) {
        std::error_code none;
        if (std::filesystem::equivalent(options.base->file, options.store, none)) {
            throw InputError{fmt::format("{}: is the road database itself, expected a raster "
                                         "after --base",
                                         options.base->file.string())};
        }
        inputs.push_back(options.base->file);
    }
    for (const auto& file : files_of(options.output)) {
        refuse_to_replace(file, inputs);
    }
}

/// Box that holds all that a picture of a box shows: the shorter side is extended to its shape.
GeoBox frame_around(const GeoBox& box, const PictureSize& size) {
    const GeoPoint south_west{box.south_deg, box.west_deg};
    const double side_m = std::max(distance_m(south_west, {box.south_deg, box.east_deg}),
                                   distance_m(south_west, {box.north_deg, box.west_deg}));
    const auto [narrow_px, wide_px] = std::minmax({size.width_px, size.height_px});
    const double shape = narrow_px > 0 ? 1.0 * wide_px / narrow_px : 1;
    return grown_over(box, 0.75 * shape * side_m); // half is needed; titles and legends take some
}

/// Returns what a map reads of a database on a server: with --bbox what the picture may show
/// around it, else all, as roads that are not selected are shown, too.
ServerNeed need_of(const RenderOptions& options) {
    ServerNeed need;
    need.content.background = options.background;
    need.content.passes =
        options.events || options.since_ms || selects_passes(options.filter) || !options.filter.box;
    if (options.filter.box && options.filter.vehicle.empty()) {
        SegmentFilter around;
        around.with_state_only = false;
        around.box = frame_around(*options.filter.box, options.output.size);
        need.segments = around;
    }
    return need;
}

void run_render(const Arguments& arguments, const Console& console) {
    auto options = parse_render(arguments, console);
    expect_files_apart(options, arguments);
    const auto store = opened_reader(options.store, console, Audience::anyone, need_of(options));
    complete_filter(options.filter, store);
    warn_of_waiting(store, options.store, console);
    warn_of_empty_map(store, console);
    tell_publication(store, console);
    if (options.style.classes == nullptr) {
        options.style.classes = class_table(store.settings().class_table);
    }
    warn_of_look(options.style, console);
    WatchedBaseMap base;
    if (options.base) {
        base = opened_base_map(options.base->file);
        for (const auto& file : files_of(options.output)) {
            refuse_to_replace(file, {base.map->files.begin(), base.map->files.end()});
        }
        options.style.base_opacity = options.base->opacity.value_or(options.style.base_opacity);
    }
    const MapRequest request{.filter = options.filter,
                             .selection = options.selection,
                             .title = options.title,
                             .style = options.style,
                             .projection = projection_of(options.output),
                             .base = base.map,
                             .size = options.output.size,
                             .other_sizes = options.output.other_sizes,
                             .events =
                                 options.events && can_show_events(store, options.filter, console),
                             .scale_denominator = options.output.scale_denominator,
                             .insets = !options.output.bare,
                             .details = !options.output.bare,
                             .background = options.background};
    auto plan = options.since_ms    ? load_change_map(store, request, *options.since_ms)
                : options.knowledge ? load_knowledge_map(store, request, *options.knowledge)
                                    : load_map(store, request);
    const auto progress = console.progress("drawing");
    const auto last_seen_ms = store.seen().last_ms;
    const auto words =
        write_picture(std::move(plan),
                      options.output,
                      last_seen_ms ? utc_day(*last_seen_ms) + "T00:00:00Z" : std::string{},
                      progress,
                      [&] { store.expect_in_place(); });
    if (base.map && !*base.is_seen) {
        console.warn(fmt::format("{}: does not overlap the map, which is drawn without it",
                                 options.base->file.string()));
    }
    console.say(fmt::format("{}: {}",
                            options.output.to_standard_output ? "standard output"
                                                              : options.output.file.string(),
                            words));
}

constexpr std::array operands{source_operand};
constexpr std::array output_options{
    picture_output_option,
    picture_format_option,
    Option{"--compare-since",
           "DATE",
           "Show what became rougher or smoother since this day: 2026-03-01 or 2026-03."},
    colour_by_option};
constexpr std::array map_options{
    picture_size_option,
    dpi_option,
    scale_option,
    crs_option,
    world_file_option,
    bare_option,
    paper_option,
    landscape_option,
    in_group("page", {"--title", "TEXT", "Title above the map.", "Road roughness"}),
    preference(one_of(
        "fhwa|five",
        in_group("appearance",
                 {"--classes", "NAME", "fhwa (good, fair, poor) or five.", "as in the database"}))),
    preference(one_of(
        "rdylbu|cividis|viridis",
        in_group(
            "appearance",
            {"--ramp",
             "NAME",
             "Colour ramp: rdylbu, cividis or viridis; all are suitable for colour-blind readers.",
             "rdylbu"}))),
    preference(
        one_of("light|dark|print",
               in_group("appearance", {"--theme", "NAME", "light, dark or print.", "light"}))),
    preferred_units_option,
    style_option,
    base_option,
    base_opacity_option,
    grey_below_option,
    in_group("appearance", {"--events", "", "Also potholes, bumps, joints and rails, as symbols."}),
    in_group("appearance",
             {"--no-background",
              "",
              "Omit water, green, built-up land, buildings, railways and names of places."}),
    in_group("appearance", {"--no-labels", "", "Omit road names."}),
    preference(in_group(
        "appearance",
        {"--left-hand", "", "Traffic keeps left: draw each direction on the left side."}))};
constexpr auto options = joined(output_options, selection_options, map_options);

} // namespace

const Command render_command{.name = "render",
                             .summary = "Draw the roughness map as a picture or PDF page",
                             .about =
                                 "Draws each direction on its own side of the road where there "
                                 "is room, and roads without a pass in grey,\nwith legend, "
                                 "scale bar, period and source. --bbox is the area to show; with "
                                 "other selections, the map\nshows what is selected in colour, and "
                                 "all other roads in grey. Needs no display.",
                             .example = "  macadam render roads.gpkg -o map.png\n"
                                        "  macadam render roads.gpkg -o centre.png --bbox "
                                        "11.55,49.93,11.60,49.96 --size 4096x4096\n"
                                        "  macadam render roads.gpkg -o poor.png --road haupt "
                                        "--class poor\n"
                                        "  macadam render roads.gpkg -o change.png "
                                        "--compare-since 2026-04\n"
                                        "  macadam render roads.gpkg -o coverage.png --colour-by "
                                        "passes\n"
                                        "  macadam render roads.gpkg -o map.tif --bare --crs "
                                        "EPSG:3006\n"
                                        "  macadam render roads.gpkg -o map.pdf --paper A3 "
                                        "--landscape\n"
                                        "  macadam render roads.gpkg -o poster.png --size A2 "
                                        "--dpi 300\n"
                                        "  macadam render roads.gpkg -o map.png --base "
                                        "aerial.mbtiles\n"
                                        "  macadam render roads.gpkg -o map.png --classes five "
                                        "--theme dark --title \"Winter 2026\"",
                             .operands = operands,
                             .options = options,
                             .run = run_render};

} // namespace macadam
