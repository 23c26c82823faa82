#include "app/export/site_export.hpp"

#include "app/export/site_folder.hpp"
#include "app/export/site_overview.hpp"
#include "app/export/site_segments.hpp"
#include "app/export/tile_export.hpp"
#include "app/site/site_json.hpp"
#include "app/site/site_manifest.hpp"
#include "app/site/site_names.hpp"
#include "app/site/site_page.hpp"
#include "app/site/site_totals.hpp"

#include "estimator/common/error.hpp"
#include "mapping/analysis/worst_sections.hpp"
#include "storage/atomic/atomic_folder.hpp"
#include "storage/networks/network_file.hpp"
#include "storage/store/server/reader/local_copy.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <system_error>
#include <vector>

namespace macadam {
namespace {

constexpr std::size_t names_of_shard = 1000;
constexpr std::size_t worst_count = 200;

void copy_page(const std::filesystem::path& page, const SiteFolder& folder) {
    std::error_code failed;
    std::filesystem::copy(page, folder.place, std::filesystem::copy_options::recursive, failed);
    if (!failed) { // the queue is a server's
        std::filesystem::remove_all(folder.place / "queue", failed);
    }
    if (failed) {
        throw InputError{
            fmt::format("{}: cannot copy the page: {}", folder.shown.string(), failed.message())};
    }
}

std::vector<SegmentRecord>
measured_segments(const StoreReader& store, SegmentFilter filter, const Progress& progress) {
    filter.with_state_only = true;
    std::vector<SegmentRecord> records;
    store.visit(filter, [&](const SegmentRecord& record) {
        if (progress.stop.stop_requested()) {
            throw InputError{"stopped"};
        }
        records.push_back(record);
    });
    if (records.empty()) {
        throw InputError{fmt::format("{}: the selection contains no measured segment, expected "
                                     "at least one",
                                     store.file().string())};
    }
    return records;
}

void write_names(const SiteNames& names, const SiteFolder& folder) {
    std::vector<std::string> first_keys, rows;
    const auto write = [&] {
        folder.write(fmt::format("names/{}.json", first_keys.size() - 1), json_array(rows));
        rows.clear();
    };
    for (const auto& name : names) {
        if (rows.empty()) {
            first_keys.push_back(name.first);
        }
        rows.push_back(name_json(name));
        if (rows.size() == names_of_shard) {
            write();
        }
    }
    if (!rows.empty()) {
        write();
    }
    folder.write("names/index.json", json_string_array(first_keys));
}

void write_worst(const StoreReader& store,
                 const std::vector<SegmentRecord>& records,
                 const SiteFolder& folder) {
    WorstSectionConfig config;
    config.above_mm_per_m = poor_above(*class_table(store.settings().class_table));
    auto sections = worst_sections(load_or_build_network(store), records, config);
    sections.resize(std::min(sections.size(), worst_count));
    folder.write("worst.json", worst_json(sections, records));
}

/// Address of a server's tiles, relative to its page.
std::string served_tiles(std::string_view place, const std::string& version) {
    return fmt::format("{}/WebMercatorQuad/{{z}}/{{y}}/{{x}}?v={}", place, version);
}

SiteSources file_sources(const SitePlan& plan) {
    const auto version = // those of two versions must not be mixed
        plan.served_version.empty() ? std::string{} : "?v=" + plan.served_version;
    const auto sharded = [&](const std::string& name) {
        return JsonObject{}
            .add("index", name + "/index.json" + version)
            .add("url", name + "/{shard}.json" + version)
            .text();
    };
    JsonObject tiles;
    if (plan.served_version.empty()) {
        tiles.add("pmtiles", "roads.pmtiles");
    } else {
        tiles.add("url", served_tiles("tiles", plan.served_version));
    }
    tiles.add("min_zoom", std::int64_t{plan.tiles.min_zoom})
        .add("max_zoom", std::int64_t{plan.tiles.max_zoom});
    return {.tiles = tiles.text(),
            .segments = sharded("segments"),
            .names = sharded("names"),
            .compare = JsonObject{}
                           .add("url", "months/{z}/{x}/{y}.json" + version)
                           .add("zoom", std::int64_t{compare_zoom})
                           .text()};
}

/// Leaves out months that do not touch the period of a filter.
std::vector<std::string> months_within(std::vector<std::string> months, const Period& period) {
    std::erase_if(months, [&](const std::string& month) {
        const auto whole = period_of_month(month);
        return (period.from_ms && *whole.until_ms <= *period.from_ms) ||
               (period.until_ms && *whole.from_ms >= *period.until_ms);
    });
    return months;
}

} // namespace

SiteLook parse_site_look(const Arguments& arguments, const std::filesystem::path& store) {
    return {.title = arguments.value("--title").value_or(title_of(store)),
            .left_hand = arguments.flag("--left-hand")};
}

SiteSegments export_site(const StoreReader& store,
                         const SegmentFilter& filter,
                         const std::filesystem::path& folder,
                         const SitePlan& plan,
                         const Console& console) {
    const auto target = folder.has_filename() ? folder : folder.parent_path();
    const auto page = site_page_folder();
    AtomicFolder output{target};
    const SiteFolder files{target, output.temporary()};
    copy_page(page, files);

    const auto records = measured_segments(store, filter, console.progress("reading segments"));
    SiteTotals totals{*class_table(store.settings().class_table)};
    SiteNames names;
    SiteManifest manifest{
        .title = plan.look.title,
        .left_hand = plan.look.left_hand,
        .bounds = {},
        .segments = records.size(),
        .digest = plan.served_version,
        .months = months_within(site_months(store), filter.period.value_or(Period{})),
        .overview = {},
        .first_picture = {},
        .pictures =
            plan.served_version.empty() ? "" : served_tiles("map/tiles", plan.served_version),
        .sources = file_sources(plan)};
    for (const auto& record : records) {
        totals.add(record);
        add_name(names, record);
        manifest.bounds = joined_box(manifest.bounds, box_around(record.segment.line));
    }
    auto segments = write_segments(store,
                                   filter,
                                   records,
                                   manifest.months,
                                   files,
                                   plan.earlier,
                                   console.progress("writing months"));
    write_names(names, files);
    write_worst(store, records, files);
    files.write("totals.json", totals.json());
    for (const auto* const language : languages()) {
        files.write(fmt::format("words/{}.json", language->code), words_json(*language));
    }
    const bool has_own_tiles = plan.served_version.empty();
    if (has_own_tiles && write_overview(store,
                                        filter,
                                        files.place / overview_file,
                                        plan.look.title,
                                        plan.look.left_hand,
                                        console)) {
        manifest.overview = overview_file;
    }
    if (!has_own_tiles || !manifest.overview.empty()) {
        manifest.first_picture = write_first_pictures(
            store, filter, files.place, manifest.bounds, plan.look.left_hand, console);
    }
    files.write("site.json", manifest_json(store, manifest, totals));
    if (has_own_tiles) {
        write_vector_tiles(store, filter, files.place / "roads.pmtiles", plan.tiles, console);
    }
    store.expect_in_place();
    output.commit();
    console.say(fmt::format("{}: a site of {}, {:.1f} km; put the folder on any web server",
                            folder.string(),
                            counted(records.size(), "segment"),
                            totals.km()));
    return segments;
}

} // namespace macadam
