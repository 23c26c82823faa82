#include "app/commands.hpp"
#include "app/map_scene.hpp"
#include "app/map_style.hpp"
#include "app/segment_options.hpp"

#include "estimator/common/error.hpp"
#include "render/colour.hpp"
#include "storage/atomic_file.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>

namespace macadam {
namespace {

struct RenderOptions {
    std::filesystem::path store;
    std::filesystem::path output;
    std::optional<GeoBox> box;
    int width_px;
    int height_px;
    std::string title;
    MapStyle style;
};

constexpr std::string_view default_size = "1600x1200";

std::pair<int, int> size_of(const std::string& text) {
    int width = 0;
    int height = 0;
    const auto* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, width);
    const bool crossed = first.ec == std::errc{} && first.ptr != end && *first.ptr == 'x';
    const auto second = crossed ? std::from_chars(first.ptr + 1, end, height) : first;
    const auto fits = [](int px) { return px >= least_image_px && px <= most_image_px; };
    if (!crossed || second.ec != std::errc{} || second.ptr != end || !fits(width) ||
        !fits(height)) {
        throw UsageError{fmt::format("--size is '{}', expected WxH with both from {} to {} pixels",
                                     text,
                                     least_image_px,
                                     most_image_px)};
    }
    return {width, height};
}

std::vector<std::string_view> ramp_names() {
    std::vector<std::string_view> names;
    for (const auto& ramp : colour_ramps()) {
        names.push_back(ramp.name);
    }
    return names;
}

std::optional<int> least_passes_of(const Arguments& arguments) {
    constexpr std::int64_t most = 1'000'000;
    const auto passes = arguments.integer("--min-passes");
    if (passes && (*passes < 1 || *passes > most)) {
        throw UsageError{fmt::format("--min-passes is {}, expected 1 to {}", *passes, most)};
    }
    return passes ? std::optional{static_cast<int>(*passes)} : std::nullopt;
}

MapStyle style_of(const Arguments& arguments) {
    constexpr std::array<std::string_view, 3> themes{"light", "dark", "print"};
    constexpr std::array<std::string_view, 2> units{"mm/m", "in/mi"};

    auto style = parse_style_file(arguments);
    if (arguments.value("--theme")) {
        const auto theme = arguments.choice("--theme", themes);
        style.theme = theme == "dark"    ? MapStyle::Theme::dark
                      : theme == "print" ? MapStyle::Theme::print
                                         : MapStyle::Theme::light;
    }
    if (arguments.value("--ramp")) {
        style.ramp = arguments.choice("--ramp", ramp_names());
        style.own_ramp.clear();
    }
    if (arguments.value("--unit")) {
        style.in_per_mi = arguments.choice("--unit", units) == "in/mi";
    }
    style.left_hand_traffic = arguments.flag("--left-hand");
    style.labels = !arguments.flag("--no-labels");
    style.least_passes = least_passes_of(arguments).value_or(style.least_passes);
    if (const auto name = arguments.value("--classes")) {
        style.classes = class_table_option(*name);
    }
    return style;
}

RenderOptions parse_render(const Arguments& arguments) {
    const auto output = arguments.value("--output");
    if (!output || !output->ends_with(".png")) {
        throw UsageError{output
                             ? fmt::format("-o is '{}', expected a name that ends in .png", *output)
                             : std::string{"-o map.png is missing"}};
    }
    const auto [width, height] =
        size_of(arguments.value("--size").value_or(std::string{default_size}));
    RenderOptions options{.store = store_file(arguments),
                          .output = *output,
                          .box = {},
                          .width_px = width,
                          .height_px = height,
                          .title = arguments.value("--title").value_or("Road roughness"),
                          .style = style_of(arguments)};
    if (const auto degrees = arguments.numbers("--bbox", 4)) {
        options.box = box_of(*degrees);
    }
    return options;
}

void run_render(const Arguments& arguments, const Console& console) {
    auto options = parse_render(arguments);
    const auto store = RoadStore::open(options.store, RoadStore::Access::read);
    warn_of_waiting(store, options.store, console);
    if (options.style.classes == nullptr) {
        options.style.classes = class_table(store.settings().class_table);
    }
    warn_of_look(options.style, console);
    const auto scene = map_scene(
        store, options.box, *options.style.classes, options.title, options.style.least_passes);
    const auto png =
        encode_png(render_map(scene, options.style, options.width_px, options.height_px));

    AtomicFile file{options.output};
    file.write(
        {reinterpret_cast<const char*>(png.data()), png.size()}); // NOLINT(*-reinterpret-cast)
    file.commit();
    console.say(fmt::format(
        "{}: {} x {} pixels", options.output.string(), options.width_px, options.height_px));
}

constexpr std::array operands{store_operand};
constexpr std::array options{
    Option{"-o,--output", "FILE", "The picture, a .png file."},
    Option{"--bbox", "W,S,E,N", "What to show, in degrees.", "all that was driven"},
    Option{"--size", "WxH", "Pixels; lines and letters grow with it.", default_size},
    Option{"--title", "TEXT", "Over the map.", "Road roughness"},
    Option{"--classes", "NAME", "fhwa (good, fair, poor) or five.", "the store's"},
    Option{"--ramp",
           "NAME",
           "Colours: rdylbu, cividis, viridis; all safe for colour-blind eyes.",
           "rdylbu"},
    Option{"--theme", "NAME", "light, dark or print.", "light"},
    Option{"--unit", "UNIT", "Of the legend: mm/m or in/mi.", "mm/m"},
    style_option,
    Option{"--min-passes", "N", "Draw roads with fewer passes of cars in grey.", "1"},
    Option{"--no-labels", "", "Leave out the names of roads."},
    Option{"--left-hand", "", "Traffic keeps left: draw each direction on that side."}};

} // namespace

const Command render_command{.name = "render",
                             .summary = "Draw the roughness map as a picture",
                             .about =
                                 "Each direction on its own side of the road where there is room, "
                                 "roads that nobody drove in grey,\n"
                                 "with legend, scale bar, period and source. Needs no display.",
                             .example = "  macadam render roads.gpkg -o map.png\n"
                                        "  macadam render roads.gpkg -o centre.png --bbox "
                                        "11.55,49.93,11.60,49.96 --size 4096x4096\n"
                                        "  macadam render roads.gpkg -o map.png --classes five "
                                        "--theme dark --title \"Winter 2026\"",
                             .operands = operands,
                             .options = options,
                             .run = run_render};

} // namespace macadam
