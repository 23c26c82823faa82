#include "storage/store/copy/region_cut.hpp"

#include "estimator/common/error.hpp"
#include "mapping/geometry/antimeridian.hpp"
#include "mapping/geometry/area.hpp" // IWYU pragma: keep; the area of a region is one
#include "storage/atomic/atomic_file_set.hpp"
#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/store/copy/cut_out.hpp"
#include "storage/store/rows/segment_query.hpp"
#include "storage/store/schema/network_rows.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace macadam {
namespace {

/// Ways of which a segment may have a point of these ways, in order.
std::vector<std::int64_t> ways_near(Database& source, std::span<const std::int64_t> ways) {
    constexpr double margin_deg = 1e-6;
    auto select = source.prepare(
        "SELECT DISTINCT segment.way_id FROM rtree_segment_geom AS place CROSS JOIN segment"
        " ON segment.fid = place.id WHERE place.maxx >= ? AND place.minx <= ? AND place.maxy >= ?"
        " AND place.miny <= ?");
    std::vector<std::int64_t> near{ways.begin(), ways.end()};
    for (const auto& way : read_ways(source, ways)) {
        const auto [west, east] = std::ranges::minmax(way.line, {}, &GeoPoint::lon_deg);
        const auto [south, north] = std::ranges::minmax(way.line, {}, &GeoPoint::lat_deg);
        for (select.bind(west.lon_deg - margin_deg,
                         east.lon_deg + margin_deg,
                         south.lat_deg - margin_deg,
                         north.lat_deg + margin_deg);
             select.step();) {
            near.push_back(select.integer(0));
        }
    }
    std::ranges::sort(near);
    near.erase(std::ranges::unique(near).begin(), near.end());
    return near;
}

std::string box_of_roads(Database& source) {
    auto select = source.prepare("SELECT min_x, min_y, max_x, max_y FROM gpkg_contents"
                                 " WHERE table_name = 'segment'");
    select.step();
    return fmt::format(
        "{},{},{},{}", select.real(0), select.real(1), select.real(2), select.real(3));
}

} // namespace

std::vector<ChunkRows> chunks_in(StoreConnection& source, const Region& region) {
    auto place = region.place;
    place.with_state_only = false;
    const PlaceCondition condition{place};
    std::vector<std::int64_t> first_rows;
    std::vector<GeoPoint> line;
    each_segment_row(
        source.statements, place, "segment.strip, segment.geom", [&](const VisitedRow& row) {
            if (!first_rows.empty() && first_rows.back() == row.integer(0)) {
                return;
            }
            put_line_of_geometry(row.blob(1), line);
            if (!line.empty() && condition.holds_for(line)) {
                first_rows.push_back(row.integer(0));
            }
        });
    auto select = source.database.prepare("SELECT max(fid) FROM segment WHERE fid >= ?1"
                                          " AND fid < ?1 + ?2 AND strip = ?1");
    std::vector<ChunkRows> chunks;
    for (const auto first : first_rows) {
        select.bind(first, source.segments_per_chunk()).step();
        chunks.push_back({first, select.integer(0)});
    }
    return chunks;
}

GeoBox ground_of(const Region& region) {
    constexpr double margin_m = 5000; // maps show some ground beside the outermost roads
    return grown_over(region.place.box ? *region.place.box : region.place.area->box(), margin_m);
}

void refuse_empty_region(const std::string& database,
                         const Region& region,
                         const std::string& roads) {
    throw InputError{fmt::format(
        "{}: no road lies in {}; its roads lie in the box {}", database, region.words, roads)};
}

StoreCopy cut_from_file(const std::filesystem::path& from,
                        const Region& region,
                        const std::filesystem::path& file,
                        const LockWaitPolicy& wait_policy,
                        const Progress& progress) {
    expect_new_file(file);
    const auto source = open_original(from, wait_policy);
    auto& original = source->database;
    Transaction one_moment{original, Transaction::Kind::read};
    const auto chunks = chunks_in(*source, region);
    if (chunks.empty()) {
        refuse_empty_region(from.string(), region, box_of_roads(original));
    }
    AtomicFileSet whole{file};
    Database database{whole.main_file(), Database::Access::create, file};
    cut_out(*source,
            {.chunks = chunks,
             .ways_around = ways_near(original, ways_of(original, chunks)),
             .ground = ground_of(region),
             .from = fmt::format("{} of {}", region.words, from.string())},
            database,
            progress);
    const auto digest = digest_of(original, {.report = {}, .stop = progress.stop}, chunks);
    return finish_copy(database, whole, digest, source->key, progress);
}

} // namespace macadam
