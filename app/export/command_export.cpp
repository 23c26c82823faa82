#include "app/cli/commands.hpp"
#include "app/cli/joined_options.hpp"
#include "app/cli/overwrite_guard.hpp"
#include "app/cli/row_output.hpp"
#include "app/database/empty_map_message.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "app/database/publication_messages.hpp"
#include "app/database/selection.hpp"
#include "app/database/server_store.hpp"
#include "app/export/raster_tile_export.hpp"
#include "app/export/site_export.hpp"
#include "app/export/tile_export.hpp"
#include "app/export/workbook_export.hpp"
#include "app/output/excel_option.hpp"
#include "app/output/units_option.hpp"
#include "app/query/section_output.hpp"
#include "app/render/style_options.hpp"
#include "storage/store/server/reader/local_copy.hpp"

#include "storage/atomic/atomic_file.hpp"
#include "storage/exports/event_export.hpp"
#include "storage/exports/export.hpp"
#include "storage/exports/qgis_project.hpp"
#include "storage/postgres/server_address.hpp"
#include "storage/store/reader/pass_choice.hpp"
#include "storage/tiles/tile_archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <vector>

namespace macadam {
namespace {

constexpr std::string_view project_suffix = ".qgz";

struct ExportOptions {
    std::filesystem::path store;
    std::filesystem::path output;
    SegmentFilter filter;
    std::optional<SectionOptions> sections;
    std::optional<TilePlan> tiles;
    std::optional<PicturePlan> pictures;
    std::optional<SitePlan> site;
    bool events;
    TextExport text; ///< of text formats
};

constexpr std::string_view workbook_suffix = ".xlsx";

bool is_workbook(const ExportOptions& options) {
    return options.output.extension() == workbook_suffix;
}

/// Returns what messages call the output.
std::string name_of_output(const ExportOptions& options) {
    return options.text.put ? "standard output" : options.output.string();
}

/// Returns how the output was asked for: "-o is 'a.kml'".
std::string output_option(const ExportOptions& options) {
    return options.text.put
               ? fmt::format("--format is '{}'", options.output.extension().string().substr(1))
               : fmt::format("-o is '{}'", options.output.string());
}

/// Rejects what has no points.
void expect_events_alone(const ExportOptions& options) {
    const auto suffixes = event_export_suffixes();
    const auto suffix = options.output.extension().string();
    if (std::ranges::find(suffixes, suffix) == suffixes.end() || is_tile_folder(options.output)) {
        throw UsageError{fmt::format("{}, expected a name that ends in {} with --events",
                                     output_option(options),
                                     fmt::join(suffixes, ", "))};
    }
    if (options.sections || !options.filter.with_state_only) {
        throw UsageError{"--events cannot be combined with --sections or --all"};
    }
}

/// Rejects other filters and formats: sections are reported completely and as text.
void expect_sections_alone(const ExportOptions& options) {
    expect_whole_sections(options.filter);
    if (!options.filter.with_state_only) {
        throw UsageError{"--sections and --all cannot be combined"};
    }
    if (const auto suffix = options.output.extension();
        suffix != ".csv" && suffix != ".geojson" && suffix != workbook_suffix) {
        throw UsageError{fmt::format("{}, expected a name that ends in .csv, .geojson or "
                                     ".xlsx with --sections",
                                     output_option(options))};
    }
}

bool is_project(const ExportOptions& options) {
    return options.output.extension() == project_suffix;
}

/// Rejects selections: a project shows the layer of the database.
void expect_project_alone(const Arguments& arguments) {
    std::vector<std::string_view> refused{"--all", "--sections"};
    std::ranges::transform(selection_options, std::back_inserter(refused), &Option::name);
    for (const auto option : refused) {
        if (arguments.is_given(option)) {
            throw UsageError{
                fmt::format("{} and -o FILE.qgz cannot be combined: the project shows the "
                            "database; export the selection to a .gpkg",
                            option)};
        }
    }
}

bool is_site(const Arguments& arguments) {
    return arguments.value("--format") == "site";
}

/// Parses the options of --format site.
SitePlan parse_site(const ExportOptions& options, const Arguments& arguments) {
    if (!is_tile_folder(options.output) && options.output.has_extension()) {
        throw UsageError{fmt::format("{}, expected a new or empty folder with --format site, such "
                                     "as public/",
                                     output_option(options))};
    }
    for (const std::string_view refused : {"--all",
                                           "--sections",
                                           "--events",
                                           "--tiles",
                                           "--theme",
                                           "--style",
                                           "--grey-below",
                                           "--units"}) {
        if (arguments.is_given(refused)) {
            throw UsageError{fmt::format("{} and --format site cannot be combined", refused)};
        }
    }
    return {.look = parse_site_look(arguments, options.store), .tiles = parse_tile_plan(arguments)};
}

/// Rejects what a format cannot have.
void expect_fitting(const ExportOptions& options, const Arguments& arguments) {
    const auto suffix = options.output.extension().string();
    if (options.text.excel && suffix != ".csv") {
        throw UsageError{"--excel requires -o FILE.csv; .xlsx needs no such option"};
    }
    if (options.text.units == UnitSystem::us && is_project(options)) {
        throw UsageError{"--units us and -o FILE.qgz cannot be combined: the project shows the "
                         "database, which is metric; export a .gpkg with --units us"};
    }
    if (options.text.units == UnitSystem::us && arguments.choice("--tiles") == "picture") {
        throw UsageError{"--units us has no effect on pictures, which show no values"};
    }
    if (arguments.value("--format") && !options.text.put && !is_site(arguments)) {
        throw UsageError{"--format is for -o - and for 'site'; the name of a file tells its "
                         "format"};
    }
    if (arguments.value("--title") && !is_site(arguments)) {
        throw UsageError{"--title requires --format site"};
    }
}

/// Returns the file that -o names, or for standard output a name with the suffix of --format.
std::filesystem::path parse_output(const Arguments& arguments) {
    const auto output = arguments.value("--output");
    if (!output) {
        throw UsageError{"-o FILE is missing"};
    }
    if (*output != standard_output) {
        return *output;
    }
    const auto suffix = fmt::format(".{}", arguments.choice("--format"));
    if (!is_text_suffix(suffix)) {
        throw UsageError{fmt::format("-o - cannot write {}, which needs a file; expected --format "
                                     "geojson, geojsonl, csv or kml",
                                     suffix)};
    }
    return "standard_output" + suffix;
}

ExportOptions parse_export(const Arguments& arguments, const Console& console) {
    const auto output = parse_output(arguments).string();
    std::vector<std::string_view> suffixes{export_suffixes().begin(), export_suffixes().end()};
    suffixes.push_back(workbook_suffix);
    std::ranges::copy(tile_archive_suffixes(), std::back_inserter(suffixes));
    suffixes.push_back(project_suffix);
    if (std::ranges::none_of(suffixes, [&](auto suffix) { return output.ends_with(suffix); }) &&
        !is_tile_folder(output) && !is_site(arguments)) {
        throw UsageError{fmt::format("-o is '{}', expected a name that ends in {}, or in / for a "
                                     "folder of tiles",
                                     output,
                                     fmt::join(suffixes, ", "))};
    }
    ExportOptions options{
        .store = file_or_server(arguments),
        .output = output,
        .filter = parse_filter(arguments),
        .sections = parse_sections(arguments, false),
        .tiles = {},
        .pictures = {},
        .site = {},
        .events = arguments.flag("--events"),
        .text = {.units = parse_units(arguments), .excel = parse_excel(arguments), .put = {}}};
    if (arguments.value("--output") == standard_output) {
        options.text.put = print;
    }
    if (is_site(arguments)) {
        options.site = parse_site(options, arguments);
    }
    expect_fitting(options, arguments);
    if (options.events) {
        expect_events_alone(options);
    }
    if (is_project(options)) {
        expect_project_alone(arguments);
        expect_file(options.store.string()); // QGIS opens it by name
    }
    if (options.sections) {
        expect_sections_alone(options);
    }
    if (options.site) {
        return options;
    }
    if (is_tile_archive(options.output)) {
        options.tiles = parse_tile_plan(arguments);
        options.pictures = parse_picture_plan(arguments, *options.tiles, options.filter, console);
    } else {
        expect_no_tile_options(arguments);
        expect_no_picture_options(arguments);
    }
    return options;
}

/// Returns the files that the command reads.
std::vector<std::filesystem::path> inputs_of(const ExportOptions& options,
                                             const Arguments& arguments) {
    auto inputs = files_of_filter(arguments);
    inputs.push_back(options.store);
    if (options.sections) {
        inputs.push_back(*options.sections->sections);
        if (options.sections->exclude) {
            inputs.push_back(*options.sections->exclude);
        }
    }
    return inputs;
}

void export_sections(const StoreReader& store,
                     const ExportOptions& options,
                     const Console& console) {
    std::optional<AtomicFile> file;
    if (!options.text.put) {
        file.emplace(options.output);
    }
    std::optional<ExcelCsv> excel;
    if (options.text.excel) {
        excel.emplace(*options.text.excel);
    }
    const auto put = [&](std::string_view text) {
        const auto in_dialect = excel ? (*excel)(text) : std::string{text};
        file ? file->write(in_dialect) : print(in_dialect);
    };
    const auto& classes = *class_table(store.settings().class_table);
    auto writer = section_writer(
        options.output.extension() == ".csv" ? "csv" : "geojson", put, options.text.units);
    const auto total =
        each_section(store, *options.sections, options.filter, [&](const NamedSection& section) {
            writer.rows.add({section, classes});
        });
    writer.rows.finish();
    store.expect_in_place();
    if (file) {
        file->commit();
    }
    console.say(fmt::format("{}: {}, {}",
                            name_of_output(options),
                            counted(writer.rows.count(), "section"),
                            spoken(total, options.text.units)));
}

/// Returns what an export reads of a database on a server.
ServerNeed need_of(const ExportOptions& options) {
    ServerNeed need;
    need.content.background = options.tiles || options.site;
    need.content.passes = options.site || options.events || selects_passes(options.filter);
    if (!options.site && !options.sections && options.filter.vehicle.empty()) {
        need.segments = options.filter;
    }
    return need;
}

void run_export(const Arguments& arguments, const Console& console) {
    auto options = parse_export(arguments, console);
    if (!options.text.put) {
        refuse_to_replace(options.output, inputs_of(options, arguments));
    }
    if (options.pictures) {
        const LocalCopy copy{options.store,
                             wait_policy_for(options.store, console),
                             console.progress("reading drives")};
        export_picture_tiles(
            copy.file(), options.filter.box, options.output, *options.pictures, console);
        return;
    }
    const auto store = opened_reader(options.store, console, Audience::anyone, need_of(options));
    complete_filter(options.filter, store);
    warn_of_waiting(store, options.store, console);
    warn_of_empty_map(store, console);
    tell_publication(store, console);
    if (options.site) {
        export_site(store, options.filter, options.output, *options.site, console);
        return;
    }
    if (options.events) {
        const auto written = export_events(store, options.filter, options.output, options.text);
        console.say(fmt::format("{}: {}", name_of_output(options), counted(written, "event")));
        return;
    }
    if (is_workbook(options)) {
        export_workbook(
            store, {options.filter, options.sections, options.text.units}, options.output, console);
        return;
    }
    if (options.sections) {
        export_sections(store, options, console);
        return;
    }
    if (options.tiles) {
        export_tiles(store, options.filter, options.output, *options.tiles, console);
        return;
    }
    if (is_project(options)) {
        write_qgis_project(store, options.output);
        console.say(
            fmt::format("{}: shows {} in QGIS", options.output.string(), options.store.string()));
        return;
    }
    const auto written = export_segments(
        store, options.filter, options.output, console.progress("writing"), options.text);
    console.say(fmt::format("{}: {}", name_of_output(options), counted(written, "segment")));
}

constexpr std::array operands{source_operand};
constexpr std::array output_options{
    Option{"-o,--output",
           "FILE",
           "Output: .geojson, .geojsonl, .csv, .xlsx, .gpkg, .fgb, .shp, .kml, .qgz, .mbtiles, "
           ".pmtiles, DIR/, or -."},
    one_of("geojson|geojsonl|csv|kml|xlsx|gpkg|fgb|shp|mbtiles|pmtiles|qgz|site",
           {"--format",
            "NAME",
            "Format of -o -: geojson, geojsonl, csv or kml; or site: DIR/ becomes a web page.",
            "geojson"}),
    units_option,
    excel_option,
    zoom_option,
    tile_jobs_option,
    tiles_option,
    tile_size_option,
    tile_theme_option,
    rare(in_group("tiles", style_option)),
    rare(in_group("tiles", grey_below_option)),
    tile_left_hand_option,
    tile_no_labels_option,
    site_title_option};
constexpr std::array section_options{
    sections_option,
    section_length_option,
    homogeneous_option,
    exclude_option,
    exclude_radius_option,
    all_option,
    Option{"--events",
           "",
           "Potholes, bumps, joints and rails as points instead of segments: .geojson, .geojsonl, "
           ".csv, .gpkg, .kml."}};
constexpr auto options = joined(output_options, selection_options, section_options);

} // namespace

const Command export_command{
    .name = "export",
    .summary = "Export road segments: GeoJSON, CSV, GeoPackage, Shapefile, tiles and more",
    .about =
        "One feature for each segment and direction: a line in driving direction with IRI, its "
        "90 % interval,\n"
        "class, passes and linear reference (docs/reference/exports.md describes every "
        "column). Trips and cars are not\n"
        "exported. With --sections: one mean for each of your own sections instead "
        "(docs/reference/sections.md). The file\n"
        "appears only when it is complete.",
    .example =
        "  macadam export roads.gpkg -o roads.geojson\n"
        "  macadam export roads.gpkg -o north.csv --bbox 11.5,49.98,11.6,50.02\n"
        "  macadam export roads.gpkg -o sections.csv --sections routes.csv\n"
        "  macadam export roads.gpkg -o roads.xlsx --units us\n"
        "  macadam export roads.gpkg -o - --format geojsonl --class poor\n"
        "  macadam export roads.gpkg -o potholes.gpkg --events\n"
        "  macadam export roads.gpkg -o roads.pmtiles --zoom 6-16 --jobs 2\n"
        "  macadam export roads.gpkg -o pictures.mbtiles --tiles picture --tile-size 512\n"
        "  macadam export roads.gpkg -o tiles/                   z/x/y.pbf and metadata.json\n"
        "  macadam export roads.gpkg -o public/ --format site    a map as web page, on any server",
    .operands = operands,
    .options = options,
    .run = run_export};

} // namespace macadam
