#include "app/tiles/tile_source.hpp"

#include "estimator/common/error.hpp"
#include "mapping/background/background_levels.hpp"
#include "mapping/tiles/tile_areas.hpp"
#include "mapping/tiles/tile_generalisation.hpp"
#include "render/tiles/mvt_background.hpp"
#include "render/tiles/mvt_layer.hpp"
#include "storage/store/reader/store_background.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <string_view>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

static_assert(source_zoom == segments_from_zoom - 1);

void expect_not_stopped(const Progress& progress) {
    if (progress.stop.stop_requested()) {
        throw InputError{"stopped before the file was complete"};
    }
}

template <typename Visit>
void each_source_tile(const std::vector<WorldPoint>& line, const Visit& visit) {
    each_tile_of(box_of(line), source_zoom, tile_buffer, visit);
}

/// Background of a database that is read for tile after tile.
struct OpenBackground {
    explicit OpenBackground(const StoreReader& reader) : store{reader} {}

    std::string layers_of(const TileId& tile) {
        const auto box = tile_box(tile, double{tile_buffer} / tile_extent);
        std::vector<BackgroundTile> tiles;
        std::vector<PlaceName> places;
        {
            const std::lock_guard lock{mutex};
            tiles = store.tiles(background_level_of_zoom(tile.zoom), box);
            places = store.places(tile_box(tile));
        }
        return background_layers_of(tile, tiles, places);
    }

    StoreBackground store;
    std::mutex mutex; ///< guards the database
};

/// Returns the function of TileSource; null if the database has no background.
std::function<std::string(const TileId&)> background_of(const StoreReader& store) {
    const auto background = std::make_shared<OpenBackground>(store);
    if (background->store.size().is_empty()) {
        return {};
    }
    return [background](const TileId& tile) { return background->layers_of(tile); };
}

/// Takes segments from a store into a source.
class Intake {
public:
    Intake(TileSource& source, const Progress& progress) : source_{source}, progress_{progress} {}

    TileSegment segment(const SegmentRecord& record) {
        for (const auto& point : record.segment.line) {
            source_.box = including(source_.box, point);
        }
        constexpr std::size_t report_every = 1000;
        if (++count_ % report_every == 0) {
            progress_(count_, 0);
            expect_not_stopped(progress_);
        }
        return tile_segment(record, source_.words);
    }

private:
    TileSource& source_;
    const Progress& progress_;
    std::size_t count_ = 0;
};

// ------------------------------------------------------------------------------------- changes

/// Sorts ranges for has(), in the order of keys.
void sort(std::vector<SegmentRange>& ranges) {
    std::ranges::sort(ranges, {}, [](const SegmentRange& range) {
        return std::tuple{range.way_id, !range.forward, range.first};
    });
}

/// Tests whether one of the ranges, which do not overlap, has a key.
bool has(const std::vector<SegmentRange>& sorted, const SegmentKey& key) {
    const auto after = std::ranges::upper_bound(sorted, key, {}, [](const SegmentRange& range) {
        return SegmentKey{range.way_id, range.forward, range.first};
    });
    if (after == sorted.begin()) {
        return false;
    }
    const auto& range = *std::prev(after);
    return range.way_id == key.way_id && range.forward == key.forward && key.index < range.past;
}

/// Segments that were read again, by tile; tiles where they lie but show nothing are empty.
struct NewSegments {
    std::map<TileId, std::vector<TileSegment>> by_tile;
    bool is_border_free = false; ///< a segment at an edge of the source's box has no value
};

bool touches_edge(const GeoBox& box, const GeoPoint& point) {
    return point.lon_deg == box.west_deg || point.lon_deg == box.east_deg ||
           point.lat_deg == box.south_deg || point.lat_deg == box.north_deg;
}

NewSegments read_again(const StoreReader& store,
                       const std::vector<SegmentRange>& ranges,
                       TileSource& source,
                       const Progress& progress) {
    NewSegments found;
    Intake intake{source, progress};
    SegmentFilter filter;
    filter.with_state_only = false;
    filter.ranges = ranges;
    const auto take = [&](const SegmentRecord& record) {
        if (record.state) {
            const auto segment = intake.segment(record);
            each_source_tile(segment.line,
                             [&](const TileId& tile) { found.by_tile[tile].push_back(segment); });
            return;
        }
        found.is_border_free = found.is_border_free ||
                               std::ranges::any_of(record.segment.line, [&](const GeoPoint& point) {
                                   return touches_edge(source.box, point);
                               });
        std::vector<WorldPoint> line;
        std::ranges::transform(record.segment.line, std::back_inserter(line), world_point);
        each_source_tile(line, [&](const TileId& tile) { found.by_tile.try_emplace(tile); });
    };
    store.visit(filter, take, StateDetail::tiles);
    return found;
}

constexpr auto key_of = [](const TileSegment& segment) { return segment.state.segment; };

/// Bytes of a tile with new segments in place of those of the ranges.
std::string replaced(std::string_view before,
                     const std::vector<SegmentRange>& ranges,
                     std::vector<TileSegment> fresh) {
    auto segments = tile_segments_in(before);
    const auto stale = std::ranges::stable_partition(
        segments, [&](const TileSegment& each) { return !has(ranges, key_of(each)); });
    segments.erase(stale.begin(), stale.end());
    std::ranges::move(fresh, std::back_inserter(segments));
    std::ranges::sort(segments, {}, key_of);
    std::string after;
    for (const auto& each : segments) {
        append_to(after, each);
    }
    return after;
}

GeoBox box_of_measured(const StoreReader& store, const Progress& progress) {
    GeoBox box;
    SegmentFilter filter;
    filter.with_state_only = true;
    store.visit_summaries(filter, [&](const SegmentSummary& segment) {
        expect_not_stopped(progress);
        for (const auto& point : segment.line) {
            box = including(box, point);
        }
    });
    return box;
}

} // namespace

void add(TileSource& source, const TileSegment& segment) {
    each_source_tile(segment.line, [&](const TileId& tile) { source.segments.add(tile, segment); });
    ++source.count;
}

void read_tile_source(const StoreReader& store,
                      const SegmentFilter& filter,
                      TileSource& source,
                      const Progress& progress) {
    Intake intake{source, progress};
    store.visit(
        filter,
        [&](const SegmentRecord& record) { add(source, intake.segment(record)); },
        StateDetail::tiles);
    source.segments.settle();
    source.background = background_of(store);
}

std::optional<std::vector<TileId>> update_tile_source(const StoreReader& store,
                                                      std::vector<SegmentRange> ranges,
                                                      TileSource& source,
                                                      const Progress& progress) {
    constexpr std::size_t few = 10'000, share = 8; // of all segments, up to which it pays
    std::size_t count = 0;
    for (const auto& range : ranges) {
        count += range.past - range.first;
    }
    if (count > std::max(few, source.count / share)) {
        return std::nullopt;
    }
    sort(ranges);
    std::vector<TileId> changed;
    auto found = read_again(store, ranges, source, progress);
    for (auto& [tile, segments] : found.by_tile) {
        const auto before = source.segments.read(tile);
        const auto after = replaced(before, ranges, std::move(segments));
        if (after != before) {
            source.segments.put(tile, after);
            changed.push_back(tile);
        }
    }
    if (found.is_border_free) {
        source.box = box_of_measured(store, progress);
    }
    source.segments.compact();
    return changed;
}

} // namespace macadam
