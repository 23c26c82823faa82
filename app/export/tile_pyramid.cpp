#include "app/export/tile_pyramid.hpp"

#include "app/parallel/parallel_for.hpp"
#include "estimator/common/error.hpp"
#include "mapping/tiles/tile_generalisation.hpp"
#include "render/tiles/mvt_background.hpp"
#include "render/tiles/mvt_tile.hpp"
#include "storage/files/gzip.hpp"
#include "storage/store/reader/store_background.hpp"

#include <algorithm>
#include <memory>
#include <mutex>
#include <set>
#include <vector>

namespace macadam {
namespace {

constexpr int base_zoom = segments_from_zoom - 1; // segments are in buckets of this zoom
constexpr double own_share = 0.8; // share of a tile's bytes; the rest is for other tiles' parts

void expect_not_stopped(const Progress& progress) {
    if (progress.stop.stop_requested()) {
        throw InputError{"stopped before the file was complete"};
    }
}

/// Visits the tiles of a zoom that show part of the box, with or without their buffer.
template <typename Visit>
void each_tile_of(const WorldBox& box, int zoom, bool with_buffer, const Visit& visit) {
    const auto side = std::uint64_t{1} << static_cast<unsigned>(world_bits - zoom);
    const auto buffer = with_buffer ? side * tile_buffer / tile_extent : 0;
    const auto last = (std::uint64_t{1} << static_cast<unsigned>(zoom)) - 1;
    const auto before = [&](std::uint32_t at) { return at < buffer ? 0 : (at - buffer) / side; };
    const auto past = [&](std::uint32_t at) { return std::min((at + buffer) / side, last); };
    for (auto y = before(box.min_y); y <= past(box.max_y); ++y) {
        for (auto x = before(box.min_x); x <= past(box.max_x); ++x) {
            visit(TileId{static_cast<std::uint8_t>(zoom),
                         static_cast<std::uint32_t>(x),
                         static_cast<std::uint32_t>(y)});
        }
    }
}

WorldBox area_of(const TileId& tile) {
    const auto side = std::uint64_t{1} << static_cast<unsigned>(world_bits - tile.zoom);
    const auto end = [&](std::uint32_t at) {
        return static_cast<std::uint32_t>((at + 1) * side - 1);
    };
    return {static_cast<std::uint32_t>(tile.x * side),
            static_cast<std::uint32_t>(tile.y * side),
            end(tile.x),
            end(tile.y)};
}

TileId child_of(const TileId& tile, unsigned quarter) {
    return {static_cast<std::uint8_t>(tile.zoom + 1),
            2 * tile.x + quarter % 2,
            2 * tile.y + quarter / 2};
}

template <typename Item>
std::vector<const Item*> pointers_to(const std::vector<Item>& items) {
    std::vector<const Item*> pointers;
    for (const auto& item : items) {
        pointers.push_back(&item);
    }
    return pointers;
}

/// Parts of one zoom by the tile that they belong to, and the tiles that show any.
struct PartLevel {
    explicit PartLevel(const std::filesystem::path& beside) : parts{beside} {}
    TileBuckets parts;
    std::set<TileId> shown;
};

/// Segment with its extent.
struct Drawn {
    const TileSegment* segment;
    WorldBox box;
};

class Pyramid {
public:
    Pyramid(const TileSource& source,
            const ClassTable& classes,
            const TilePlan& plan,
            const PutTile& put,
            const Progress& progress)
        : source_{source}, classes_{classes}, plan_{plan}, put_{put}, progress_{progress},
          beside_{source.segments.beside()} {}

    TileCount make() {
        const bool has_parts = plan_.min_zoom <= base_zoom;
        const bool has_both = plan_.min_zoom < directions_from_zoom;
        Levels base{has_parts ? new_level() : nullptr, has_both ? new_level() : nullptr};
        const auto tiles = source_.segments.tiles();
        each(tiles, [&](const TileId& tile) { draw_base(tile, base); });
        if (source_.background && plan_.max_zoom > base_zoom) {
            each(tiles_beside(tiles), [&](const TileId& tile) { draw_ground_within(tile); });
        }
        if (has_parts) {
            draw_levels(std::move(base));
        }
        return count_;
    }

private:
    using Level = std::unique_ptr<PartLevel>;

    /// Parts of each direction, and of both together.
    struct Levels {
        Level directed, both;
    };

    Level new_level() const { return std::make_unique<PartLevel>(beside_); }

    VectorTileContext context() const { return {&source_.words, &classes_, plan_.units}; }

    template <typename Work>
    void each(const std::vector<TileId>& tiles, const Work& work) {
        parallel_for(
            tiles.size(), plan_.jobs, [&](std::size_t i) { work(tiles[i]); }, {{}, progress_.stop});
        expect_not_stopped(progress_);
    }

    void put(const TileId& tile, const std::string& bytes, int steps) {
        const std::lock_guard lock{mutex_};
        put_(tile, bytes);
        count_.largest_bytes = std::max(count_.largest_bytes, std::uint64_t{bytes.size()});
        note_steps(steps);
        constexpr std::size_t report_every = 100;
        if (++count_.tiles % report_every == 0) {
            progress_(count_.tiles, 0);
        }
    }

    void note_steps(int steps) {
        count_.coarsened += steps > 0 ? 1 : 0;
        count_.max_steps = std::max(count_.max_steps, steps);
    }

    // ------------------------------------------------------------------------------ background

    /// Returns a tile's layers with those of its background, gzipped.
    std::string packed_with_ground(const TileId& tile, const std::string& roads) const {
        if (source_.background) {
            if (auto packed = gzipped(source_.background(tile) + roads);
                packed.size() <= plan_.max_bytes) {
                return packed;
            }
        }
        return gzipped(roads);
    }

    /// Draws a tile without segments.
    void draw_ground(const TileId& tile) {
        if (const auto bytes = source_.background(tile); !bytes.empty()) {
            if (const auto packed = gzipped(bytes); packed.size() <= plan_.max_bytes) {
                put(tile, packed, 0);
            }
        }
    }

    /// Draws the tiles within a tile, which have no segments.
    void draw_ground_within(const TileId& tile) {
        for (unsigned quarter = 0; tile.zoom < plan_.max_zoom && quarter < 4; ++quarter) {
            const auto child = child_of(tile, quarter);
            if (child.zoom >= plan_.min_zoom) {
                draw_ground(child);
            }
            draw_ground_within(child);
        }
    }

    /// Returns the neighbours of tiles.
    static std::vector<TileId> tiles_beside(const std::vector<TileId>& tiles) {
        std::set<TileId> beside;
        for (const auto& tile : tiles) {
            const auto last = (std::uint32_t{1} << unsigned{tile.zoom}) - 1;
            for (auto x = tile.x - std::min(tile.x, 1U); x <= std::min(tile.x + 1, last); ++x) {
                for (auto y = tile.y - std::min(tile.y, 1U); y <= std::min(tile.y + 1, last); ++y) {
                    beside.insert({tile.zoom, x, y});
                }
            }
        }
        for (const auto& tile : tiles) {
            beside.erase(tile);
        }
        return {beside.begin(), beside.end()};
    }

    // -------------------------------------------------------------------------------- segments

    void draw_base(const TileId& tile, const Levels& base) {
        const auto segments = tile_segments_in(source_.segments.read(tile));
        std::vector<Drawn> drawn;
        std::vector<TileSegment> own;
        for (const auto& segment : segments) {
            drawn.push_back({&segment, box_of(segment.line)});
            if (base.directed && tile_at(middle_of(segment), base_zoom) == tile) {
                own.push_back(segment);
            }
        }
        for (unsigned quarter = 0; plan_.max_zoom > base_zoom && quarter < 4; ++quarter) {
            draw_segments(child_of(tile, quarter), drawn);
        }
        if (base.directed && !own.empty()) {
            keep(tile, generalised_to_fit(tile, parts_of(own, classes_)), *base.directed);
        }
        if (base.both && !own.empty()) {
            keep(tile,
                 generalised(
                     parts_of_both_ways(own, classes_), generalisation_at(base_zoom), classes_),
                 *base.both);
        }
    }

    /// Draws a tile and those within it.
    void draw_segments(const TileId& tile, const std::vector<Drawn>& near) {
        const auto shown = shown_by(tile), area = area_of(tile);
        std::vector<Drawn> drawn;
        bool has_any = false;
        for (const auto& candidate : near) {
            if (meet(candidate.box, shown)) {
                drawn.push_back(candidate);
                has_any = has_any || meet(candidate.box, area);
            }
        }
        if (!has_any) {
            if (source_.background) {
                if (tile.zoom >= plan_.min_zoom) {
                    draw_ground(tile);
                }
                draw_ground_within(tile);
            }
            return;
        }
        if (tile.zoom >= plan_.min_zoom) {
            draw_segment_tile(tile, drawn);
        }
        for (unsigned quarter = 0; tile.zoom < plan_.max_zoom && quarter < 4; ++quarter) {
            draw_segments(child_of(tile, quarter), drawn);
        }
    }

    void draw_segment_tile(const TileId& tile, const std::vector<Drawn>& drawn) {
        std::vector<const TileSegment*> segments;
        for (const auto& each : drawn) {
            segments.push_back(each.segment);
        }
        int steps = 0;
        for (const auto detail : {SegmentDetail::full, SegmentDetail::less}) {
            const auto bytes = vector_tile(tile, segments, detail, context());
            if (bytes.empty()) { // near the tile, but outside of it in tile units
                if (source_.background) {
                    draw_ground(tile);
                }
                return;
            }
            if (const auto packed = packed_with_ground(tile, bytes);
                packed.size() <= plan_.max_bytes) {
                put(tile, packed, steps);
                return;
            }
            ++steps;
        }
        draw_own_parts(tile, segments, steps);
    }

    /// Draws a tile with too many segments as parts of the segments with a midpoint in it.
    void draw_own_parts(const TileId& tile,
                        const std::vector<const TileSegment*>& segments,
                        int steps_before) {
        std::vector<TileSegment> own;
        for (const auto* const segment : segments) {
            if (tile_at(middle_of(*segment), tile.zoom) == tile) {
                own.push_back(*segment);
            }
        }
        const auto [parts, steps] = fitted(tile, parts_of(own, classes_));
        if (const auto bytes = vector_tile(tile, pointers_to(parts), context()); !bytes.empty()) {
            put(tile, packed_with_ground(tile, bytes), steps_before + steps);
        }
    }

    // ----------------------------------------------------------------------------------- parts

    struct Fitted {
        std::vector<RoadPart> parts;
        int steps;
    };

    bool fits(const TileId& tile, const std::vector<RoadPart>& parts) const {
        const auto limit = own_share * static_cast<double>(plan_.max_bytes);
        constexpr double bytes_of_part = 100, bytes_of_point = 10; // uncompressed, at most
        double most = 0;
        for (const auto& part : parts) {
            most += bytes_of_part + bytes_of_point * static_cast<double>(part.line.size());
        }
        if (most <= limit) { // avoids making most tiles twice
            return true;
        }
        const auto bytes = vector_tile(tile, pointers_to(parts), context());
        return static_cast<double>(gzipped(bytes).size()) <= limit;
    }

    /// Returns the parts after the first step of coarsening that makes the tile small enough.
    Fitted fitted(const TileId& tile, std::vector<RoadPart> parts) const {
        constexpr int last_step = 16; // one square holds the tile, and one part is left
        for (int step = 0;; ++step) {
            parts = generalised(std::move(parts), generalisation_at(tile.zoom, step), classes_);
            if (step == last_step || fits(tile, parts)) {
                return {std::move(parts), step};
            }
        }
    }

    std::vector<RoadPart> generalised_to_fit(const TileId& tile, std::vector<RoadPart> parts) {
        auto [fit, steps] = fitted(tile, std::move(parts));
        if (steps > 0 && tile.zoom >= plan_.min_zoom && tile.zoom <= plan_.max_zoom) {
            const std::lock_guard lock{mutex_};
            note_steps(steps);
        }
        return std::move(fit);
    }

    void keep(const TileId& tile, const std::vector<RoadPart>& parts, PartLevel& level) {
        const std::lock_guard lock{mutex_};
        for (const auto& part : parts) {
            level.parts.add(tile, part);
            each_tile_of(box_of(part.line), tile.zoom, false, [&](const TileId& shown) {
                level.shown.insert(shown);
            });
        }
    }

    void draw_levels(Levels levels) {
        for (int zoom = base_zoom; zoom >= plan_.min_zoom; --zoom) {
            if (zoom < base_zoom) {
                levels = {
                    zoom >= directions_from_zoom ? level_above(*levels.directed, true) : nullptr,
                    levels.both ? level_above(*levels.both, zoom < directions_from_zoom) : nullptr};
            }
            for (auto* const level : {levels.directed.get(), levels.both.get()}) {
                if (level != nullptr) {
                    level->parts.settle();
                }
            }
            if (zoom <= plan_.max_zoom) {
                draw_level(zoom >= directions_from_zoom ? *levels.directed : *levels.both);
            }
        }
    }

    /// Makes the parts of the next zoom, in tiles four times as large.
    /// \param is_drawn  otherwise the level only leads to the zooms above and has no size limit
    Level level_above(const PartLevel& below, bool is_drawn) {
        std::set<TileId> tiles;
        for (const auto& tile : below.parts.tiles()) {
            tiles.insert({static_cast<std::uint8_t>(tile.zoom - 1), tile.x / 2, tile.y / 2});
        }
        auto level = new_level();
        each({tiles.begin(), tiles.end()}, [&](const TileId& tile) {
            std::vector<RoadPart> parts;
            for (unsigned quarter = 0; quarter < 4; ++quarter) {
                auto more = road_parts_in(below.parts.read(child_of(tile, quarter)));
                std::ranges::move(more, std::back_inserter(parts));
            }
            keep(tile,
                 is_drawn ? generalised_to_fit(tile, std::move(parts))
                          : generalised(std::move(parts), generalisation_at(tile.zoom), classes_),
                 *level);
        });
        return level;
    }

    void draw_level(const PartLevel& level) {
        const std::vector<TileId> shown{level.shown.begin(), level.shown.end()};
        each(shown, [&](const TileId& tile) { draw_part_tile(tile, level); });
        if (source_.background) {
            each(tiles_beside(shown), [&](const TileId& tile) { draw_ground(tile); });
        }
    }

    void draw_part_tile(const TileId& tile, const PartLevel& level) {
        std::vector<RoadPart> own = road_parts_in(level.parts.read(tile)), others;
        const auto shown = shown_by(tile);
        each_tile_of(area_of(tile), tile.zoom, true, [&](const TileId& near) {
            if (near == tile) {
                return;
            }
            for (auto& part : road_parts_in(level.parts.read(near))) {
                if (meet(box_of(part.line), shown)) {
                    others.push_back(std::move(part));
                }
            }
        });
        auto drawn = pointers_to(own);
        std::ranges::copy(pointers_to(others), std::back_inserter(drawn));
        std::ranges::sort(drawn, {}, [](const RoadPart* part) { return part->first; });
        auto packed = packed_tile(tile, drawn);
        int steps = 0;
        if (packed.size() > plan_.max_bytes) { // own parts fit; other tiles show the rest
            packed = packed_tile(tile, pointers_to(own));
            steps = 1;
        }
        if (!packed.empty()) {
            put(tile, packed, steps);
        }
    }

    std::string packed_tile(const TileId& tile, const std::vector<const RoadPart*>& parts) const {
        const auto bytes = vector_tile(tile, parts, context());
        return bytes.empty() ? bytes : packed_with_ground(tile, bytes);
    }

    const TileSource& source_;
    const ClassTable& classes_;
    const TilePlan& plan_;
    const PutTile& put_;
    const Progress& progress_;
    std::filesystem::path beside_;
    std::mutex mutex_; ///< guards all members below, put_, and levels being filled
    TileCount count_;
};

/// Background of a database that is read for tile after tile.
struct OpenBackground {
    explicit OpenBackground(const StoreReader& reader) : store{reader} {}

    std::string layers_of(const TileId& tile) {
        constexpr double margin = -1e-6; // of a tile: its neighbours do not count
        const auto box = tile_box(tile, margin);
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

} // namespace

void add(TileSource& source, const TileSegment& segment) {
    each_tile_of(box_of(segment.line), base_zoom, true, [&](const TileId& tile) {
        source.segments.add(tile, segment);
    });
    ++source.count;
}

void read_tile_source(const StoreReader& store,
                      const SegmentFilter& filter,
                      TileSource& source,
                      const Progress& progress) {
    constexpr std::size_t report_every = 1000;
    const auto take = [&](const SegmentRecord& record) {
        add(source, tile_segment(record, source.words));
        for (const auto& point : record.segment.line) {
            source.box = including(source.box, point);
        }
        if (source.count % report_every == 0) {
            progress(source.count, 0);
            expect_not_stopped(progress);
        }
    };
    store.visit(filter, take, StateDetail::tiles);
    source.segments.settle();
    source.background = background_of(store);
}

TileCount make_vector_tiles(const TileSource& source,
                            const ClassTable& classes,
                            const TilePlan& plan,
                            const PutTile& put,
                            const Progress& progress) {
    return Pyramid{source, classes, plan, put, progress}.make();
}

} // namespace macadam
