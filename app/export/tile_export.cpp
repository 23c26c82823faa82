#include "app/export/tile_export.hpp"

#include "app/output/units_option.hpp"
#include "app/tiles/tile_layers.hpp"

#include "estimator/common/error.hpp"
#include "storage/atomic/atomic_folder.hpp"
#include "storage/exports/export.hpp"
#include "storage/tiles/tile_archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace macadam {
namespace {

constexpr int farthest_zoom = 18; // a unit of a tile is then 4 cm at the equator

/// Parses "6-16", or "14" alone.
std::optional<std::pair<int, int>> zooms_in(const std::string& text) {
    const auto* const end = text.data() + text.size();
    int least = 0;
    const auto first = std::from_chars(text.data(), end, least);
    if (first.ec != std::errc{}) {
        return std::nullopt;
    }
    int most = least;
    auto stop = first.ptr;
    if (stop != end && *stop == '-') {
        const auto second = std::from_chars(stop + 1, end, most);
        if (second.ec != std::errc{}) {
            return std::nullopt;
        }
        stop = second.ptr;
    }
    const bool fits = stop == end && 0 <= least && least <= most && most <= farthest_zoom;
    return fits ? std::optional{std::pair{least, most}} : std::nullopt;
}

bool is_us(const TilePlan& plan) {
    return plan.units == TileUnits::us;
}

TileSetNote note_of(const StoreReader& store, const GeoBox& box, const TilePlan& plan) {
    return {.name = store.file().stem().string(),
            .description = fmt::format("Roughness of roads (IRI, {}) with its uncertainty",
                                       is_us(plan) ? "in/mi" : "mm/m"),
            .attribution = store.settings().attribution,
            .format = TileSetNote::Format::mvt,
            .bounds = box,
            .min_zoom = plan.min_zoom,
            .max_zoom = plan.max_zoom,
            .layers = tile_layers(store, plan)};
}

std::string size_text(std::uint64_t bytes) {
    constexpr double kilobyte = 1e3, megabyte = 1e6;
    const auto size = static_cast<double>(bytes);
    return size < megabyte ? fmt::format("{:.1f} kB", size / kilobyte)
                           : fmt::format("{:.1f} MB", size / megabyte);
}

} // namespace

bool is_tile_archive(const std::filesystem::path& place) {
    const auto archives = tile_archive_suffixes();
    const auto ends_in = [&](std::string_view suffix) { return place.native().ends_with(suffix); };
    if (std::ranges::any_of(export_suffixes(), ends_in)) {
        return false; // also if a folder of that name is in the way
    }
    return is_tile_folder(place) || std::ranges::any_of(archives, ends_in);
}

std::string tile_endings() {
    return fmt::format("{} or /", fmt::join(tile_archive_suffixes(), ", "));
}

TilePlan parse_tile_plan(const Arguments& arguments) {
    TilePlan plan;
    if (const auto text = arguments.value("--zoom")) {
        const auto zooms = zooms_in(*text);
        if (!zooms) {
            throw UsageError{
                fmt::format("--zoom is '{}', expected one or two of 0 to {}, as in 6-16",
                            *text,
                            farthest_zoom)};
        }
        std::tie(plan.min_zoom, plan.max_zoom) = *zooms;
    }
    plan.jobs = jobs_of(arguments);
    plan.units = parse_units(arguments) == UnitSystem::us ? TileUnits::us : TileUnits::si;
    return plan;
}

void expect_no_tile_options(const Arguments& arguments) {
    if (arguments.value("--zoom") || arguments.is_given("--jobs")) {
        throw UsageError{fmt::format("--zoom and --jobs are for tile output, expected -o to "
                                     "end in {}",
                                     tile_endings())};
    }
}

WrittenTiles write_vector_tiles(const StoreReader& store,
                                const SegmentFilter& filter,
                                const std::filesystem::path& file,
                                const TilePlan& plan,
                                const Console& console) {
    TileSource source{beside_tiles(file)};
    read_tile_source(store, filter, source, console.progress("reading segments"));
    if (source.count == 0) {
        throw InputError{fmt::format("{}: the selection contains no measured segment, expected "
                                     "at least one",
                                     store.file().string())};
    }
    TileArchive archive{file, note_of(store, tile_bounds(store, source.box), plan)};
    const auto count = make_vector_tiles(
        source,
        *class_table(store.settings().class_table),
        plan,
        [&](const TileId& tile, std::string_view bytes) { archive.add(tile, bytes); },
        console.progress("drawing tiles"));
    store.expect_in_place();
    archive.commit(console.progress("writing tiles"));
    return {source.count, count};
}

void export_tiles(const StoreReader& store,
                  const SegmentFilter& filter,
                  const std::filesystem::path& file,
                  const TilePlan& plan,
                  const Console& console) {
    if (!filter.with_state_only) {
        throw UsageError{"--all is for segment files: tiles show measured segments only"};
    }
    if (is_tile_folder(file)) {
        expect_new_or_empty(file.has_filename() ? file : file.parent_path()); // fails early
    }
    const auto [segments, count] = write_vector_tiles(store, filter, file, plan, console);
    console.say(fmt::format("{}: {} of {}, zooms {} to {}, largest {} gzipped",
                            file.string(),
                            counted(count.tiles, "tile"),
                            counted(segments, "segment"),
                            plan.min_zoom,
                            plan.max_zoom,
                            size_text(count.largest_bytes)));
    if (count.coarsened > 0) {
        console.say(
            fmt::format("{} would have been over {} and therefore show less detail of the same "
                        "roads (at most {} of coarsening)",
                        counted(count.coarsened, "tile"),
                        size_text(plan.max_bytes),
                        counted(static_cast<std::size_t>(count.max_steps), "step")));
    }
}

} // namespace macadam
