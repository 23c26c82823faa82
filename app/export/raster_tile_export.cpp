#include "app/export/raster_tile_export.hpp"

#include "app/database/lock_wait_messages.hpp"
#include "app/database/publication_messages.hpp"
#include "app/database/selection.hpp"
#include "app/export/tile_export.hpp"
#include "app/render/style_options.hpp"
#include "estimator/common/error.hpp"
#include "storage/tiles/tile_archive.hpp"

#include <fmt/format.h>

#include <utility>

#include <sys/stat.h>

namespace macadam {
namespace {

void expect_whole_network(const SegmentFilter& filter) {
    if (filter.min_passes > 0) {
        throw UsageError{"--min-passes selects segments; --tiles picture shows all roads, with "
                         "--grey-below N those of fewer passes in grey"};
    }
    auto others = filter;
    others.box.reset();
    if (selects(others) || !filter.with_state_only) {
        throw UsageError{"--tiles picture shows all roads of a box: combine it with --bbox and "
                         "--grey-below only, not with options that select segments"};
    }
    if (filter.box && filter.box->east_deg > 180) {
        throw UsageError{"--tiles picture has boxes with west < east only"};
    }
}

void expect_no_picture_looks(const Arguments& arguments) {
    if (arguments.value("--tile-size") || arguments.is_given("--theme") ||
        arguments.is_given("--style") || arguments.is_given("--left-hand") ||
        arguments.flag("--no-labels") || arguments.value("--grey-below")) {
        throw UsageError{"--tile-size, --theme, --style, --grey-below, --left-hand and "
                         "--no-labels require --tiles picture"};
    }
}

TileSetNote note_of(const StoreInfo& info, const std::string& name, const PicturePlan& plan) {
    return {.name = name,
            .description = "Roughness of roads (IRI) by class",
            .attribution = info.settings.attribution,
            .format = TileSetNote::Format::png,
            .bounds = plan.box,
            .min_zoom = plan.min_zoom,
            .max_zoom = plan.max_zoom,
            .layers = {},
            .tile_px = plan.tile_px};
}

/// Returns device and inode of a file.
std::pair<dev_t, ino_t> identity_of(const std::filesystem::path& file) {
    struct stat status {};
    return ::stat(file.c_str(), &status) == 0 ? std::pair{status.st_dev, status.st_ino}
                                              : std::pair{dev_t{}, ino_t{}};
}

/// Reads the data of the whole database, which is closed again before processes are started.
StoreInfo info_of(const std::filesystem::path& file, const Console& console) {
    const auto store = opened_reader(file, console);
    warn_of_waiting(store, file, console);
    tell_publication(store, console);
    return store.info();
}

} // namespace

std::optional<PicturePlan> parse_picture_plan(const Arguments& arguments,
                                              const TilePlan& tiles,
                                              const SegmentFilter& filter,
                                              const Console& console) {
    if (arguments.choice("--tiles") != "picture") {
        expect_no_picture_looks(arguments);
        return std::nullopt;
    }
    expect_whole_network(filter);
    return PicturePlan{.min_zoom = tiles.min_zoom,
                       .max_zoom = tiles.max_zoom,
                       .tile_px = arguments.choice("--tile-size") == "512" ? 512 : 256,
                       .jobs = tiles.jobs,
                       .box = {},
                       .style = parse_style(arguments, console)};
}

void expect_no_picture_options(const Arguments& arguments) {
    if (arguments.value("--tiles")) {
        throw UsageError{
            fmt::format("--tiles is for tile output, expected -o to end in {}", tile_endings())};
    }
    expect_no_picture_looks(arguments);
}

void export_picture_tiles(const std::filesystem::path& store,
                          const std::optional<GeoBox>& box,
                          const std::filesystem::path& file,
                          PicturePlan plan,
                          const Console& console) {
    const auto identity = identity_of(store);
    const auto info = info_of(store, console);
    if (info.segments == 0) {
        throw InputError{
            fmt::format("{}: no measured segment to draw, expected at least one", store.string())};
    }
    if (plan.style.classes == nullptr) {
        plan.style.classes = class_table(info.settings.class_table);
    }
    warn_of_look(plan.style, console);
    plan.box = box.value_or(info.box);
    PicturePainters painters{store, plan, wait_policy_for(store, console)};
    TileArchive archive{file, note_of(info, store.stem().string(), plan)};
    const auto count = painters.collect(
        [&](const TileId& tile, std::string_view bytes) { archive.add(tile, bytes); },
        console.progress("drawing tiles"));
    if (identity_of(store) != identity) {
        throw InputError{fmt::format("{}: was removed or replaced while this command was using "
                                     "it; run the command again",
                                     store.string())};
    }
    const auto size = archive.commit(console.progress("writing tiles"));
    console.say(fmt::format("{}: {} of {} x {} px, {} distinct, zooms {} to {}, largest {:.1f} kB",
                            file.string(),
                            counted(count.tiles, "tile"),
                            plan.tile_px,
                            plan.tile_px,
                            size.contents,
                            plan.min_zoom,
                            plan.max_zoom,
                            static_cast<double>(count.largest_bytes) / 1e3));
}

} // namespace macadam
