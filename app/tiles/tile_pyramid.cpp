#include "app/tiles/tile_pyramid.hpp"

#include "app/parallel/parallel_for.hpp"
#include "estimator/common/error.hpp"
#include "mapping/tiles/tile_areas.hpp"
#include "mapping/tiles/tile_generalisation.hpp"

#include <algorithm>
#include <iterator>
#include <mutex>
#include <set>
#include <string>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

void expect_not_stopped(const Progress& progress) {
    if (progress.stop.stop_requested()) {
        throw InputError{"stopped before the file was complete"};
    }
}

/// Segment with its extent.
struct Drawn {
    const TileSegment* segment;
    WorldBox box;
};

} // namespace

/// One call of update().
class TilePyramid::Update {
public:
    Update(TilePyramid& pyramid,
           const TileSource& source,
           const PutTile& put,
           const Progress& progress)
        : pyramid_{pyramid}, source_{source}, draw_{source, pyramid.classes_, pyramid.plan_},
          put_{put}, progress_{progress} {}

    TileCount run(const std::vector<TileId>& changed) {
        std::set<TileId> with_segments, without;
        for (const auto& tile : changed) {
            each_tile_around(tile, [&](const TileId& each) {
                if (!source_.segments.contains(each)) {
                    without.insert(each);
                }
            });
            with_segments.insert(tile);
        }
        each(with_segments, [&](const TileId& tile) { draw_base(tile); });
        each(without, [&](const TileId& tile) { draw_ground_within(tile, is_near_base(tile)); });
        draw_levels();
        return count_;
    }

private:
    using Level = PartLevel;

    const TilePlan& plan() const { return pyramid_.plan_; }

    template <typename Tiles, typename Work>
    void each(const Tiles& tiles, const Work& work) {
        const std::vector<TileId> all{tiles.begin(), tiles.end()};
        parallel_for(
            all.size(), plan().jobs, [&](std::size_t i) { work(all[i]); }, {{}, progress_.stop});
        expect_not_stopped(progress_);
    }

    bool is_in_plan(const TileId& tile) const {
        return tile.zoom >= plan().min_zoom && tile.zoom <= plan().max_zoom;
    }

    void put(const TileId& tile, const DrawnTile& drawn) {
        const std::lock_guard lock{mutex_};
        put_(tile, drawn.bytes);
        if (drawn.bytes.empty()) {
            return;
        }
        count_.largest_bytes = std::max(count_.largest_bytes, std::uint64_t{drawn.bytes.size()});
        note_steps(drawn.steps);
        constexpr std::size_t report_every = 100;
        if (++count_.tiles % report_every == 0) {
            progress_(count_.tiles, 0);
        }
    }

    void note_steps(int steps) {
        count_.coarsened += steps > 0 ? 1 : 0;
        count_.max_steps = std::max(count_.max_steps, steps);
    }

    void put_ground(const TileId& tile, bool has_ground) {
        put(tile, has_ground ? draw_.ground(tile) : DrawnTile{});
    }

    // -------------------------------------------------------------------------------- segments

    /// Tests whether a tile has segments or is beside one that has.
    bool is_near_base(const TileId& tile) const {
        bool is_near = false;
        each_tile_around(tile, [&](const TileId& each) {
            is_near = is_near || source_.segments.contains(each);
        });
        return is_near;
    }

    /// Draws the tiles within a tile, which have no segments.
    void draw_ground_within(const TileId& tile, bool has_ground) {
        for (unsigned quarter = 0; tile.zoom < plan().max_zoom && quarter < 4; ++quarter) {
            const auto child = child_of(tile, quarter);
            if (is_in_plan(child)) {
                put_ground(child, has_ground);
            }
            draw_ground_within(child, has_ground);
        }
    }

    void draw_base(const TileId& tile) {
        const auto segments = tile_segments_in(source_.segments.read(tile));
        if (segments.empty()) { // drawn with those beside
            set_base_parts(tile, {});
            return;
        }
        std::vector<Drawn> drawn;
        std::vector<TileSegment> own;
        for (const auto& segment : segments) {
            drawn.push_back({&segment, box_of(segment.line)});
            if (tile_at(middle_of(segment), source_zoom) == tile) {
                own.push_back(segment);
            }
        }
        for (unsigned quarter = 0; plan().max_zoom > source_zoom && quarter < 4; ++quarter) {
            draw_segments(child_of(tile, quarter), drawn);
        }
        set_base_parts(tile, own);
    }

    /// Draws a tile and those within it.
    void draw_segments(const TileId& tile, const std::vector<Drawn>& near) {
        const auto shown = shown_by(tile), area = area_of(tile);
        std::vector<Drawn> drawn;
        std::vector<const TileSegment*> segments;
        bool has_any = false;
        for (const auto& candidate : near) {
            if (meet(candidate.box, shown)) {
                drawn.push_back(candidate);
                segments.push_back(candidate.segment);
                has_any = has_any || meet(candidate.box, area);
            }
        }
        if (is_in_plan(tile)) {
            put(tile, has_any ? draw_.segments(tile, segments) : draw_.ground(tile));
        }
        if (!has_any) {
            draw_ground_within(tile, true);
            return;
        }
        for (unsigned quarter = 0; tile.zoom < plan().max_zoom && quarter < 4; ++quarter) {
            draw_segments(child_of(tile, quarter), drawn);
        }
    }

    // ----------------------------------------------------------------------------------- parts

    void set(Level& level, const TileId& tile, const std::vector<RoadPart>& parts) {
        const std::lock_guard lock{mutex_};
        level.set(tile, parts);
    }

    std::vector<RoadPart> fitted(const TileId& tile, std::vector<RoadPart> parts) {
        auto [fit, steps] = draw_.fitted(tile, std::move(parts));
        if (steps > 0 && is_in_plan(tile)) {
            const std::lock_guard lock{mutex_};
            note_steps(steps);
        }
        return std::move(fit);
    }

    std::vector<RoadPart> generalised_at(const TileId& tile, std::vector<RoadPart> parts) const {
        return generalised(std::move(parts), generalisation_at(tile.zoom), pyramid_.classes_);
    }

    void set_base_parts(const TileId& tile, const std::vector<TileSegment>& own) {
        if (const auto level = pyramid_.directed_.find(source_zoom);
            level != pyramid_.directed_.end()) {
            set(level->second, tile, fitted(tile, parts_of(own, pyramid_.classes_)));
        }
        if (const auto level = pyramid_.both_.find(source_zoom); level != pyramid_.both_.end()) {
            set(level->second,
                tile,
                generalised_at(tile, parts_of_both_ways(own, pyramid_.classes_)));
        }
    }

    void draw_levels() {
        for (int zoom = source_zoom; zoom >= plan().min_zoom; --zoom) {
            const bool is_directed = zoom >= directions_from_zoom;
            if (zoom < source_zoom) {
                raise(pyramid_.directed_, zoom, true);
                raise(pyramid_.both_, zoom, !is_directed);
            }
            if (zoom <= plan().max_zoom) {
                draw_level((is_directed ? pyramid_.directed_ : pyramid_.both_).at(zoom));
            }
        }
        for (auto* const levels : {&pyramid_.directed_, &pyramid_.both_}) {
            for (auto& [zoom, level] : *levels) {
                level.settle();
            }
        }
    }

    /// Makes the parts of a zoom that come from changed ones of the next zoom, whose tiles are a
    /// quarter as large.
    /// \param is_drawn  otherwise the level only leads to the zooms above and has no size limit
    void raise(Levels& levels, int zoom, bool is_drawn) {
        const auto level = levels.find(zoom);
        if (level == levels.end()) {
            return;
        }
        const auto& below = levels.at(zoom + 1);
        std::set<TileId> tiles;
        for (const auto& tile : below.changed()) {
            tiles.insert({static_cast<std::uint8_t>(zoom), tile.x / 2, tile.y / 2});
        }
        each(tiles, [&](const TileId& tile) {
            std::vector<RoadPart> parts;
            for (unsigned quarter = 0; quarter < 4; ++quarter) {
                auto more = below.parts_of(child_of(tile, quarter));
                std::ranges::move(more, std::back_inserter(parts));
            }
            set(level->second,
                tile,
                is_drawn ? fitted(tile, std::move(parts)) : generalised_at(tile, std::move(parts)));
        });
    }

    void draw_level(const Level& level) {
        each(level.touched(), [&](const TileId& tile) {
            if (level.shows(tile)) {
                draw_part_tile(tile, level);
                return;
            }
            bool is_near = false;
            each_tile_around(tile,
                             [&](const TileId& near) { is_near = is_near || level.shows(near); });
            put_ground(tile, is_near);
        });
    }

    void draw_part_tile(const TileId& tile, const Level& level) {
        std::vector<RoadPart> others;
        const auto shown = shown_by(tile);
        each_tile_of(area_of(tile), tile.zoom, tile_buffer, [&](const TileId& near) {
            if (near == tile) {
                return;
            }
            for (auto& part : level.parts_of(near)) {
                if (meet(box_of(part.line), shown)) {
                    others.push_back(std::move(part));
                }
            }
        });
        put(tile, draw_.parts(tile, level.parts_of(tile), others));
    }

    TilePyramid& pyramid_;
    const TileSource& source_;
    TileDrawing draw_;
    const PutTile& put_;
    const Progress& progress_;
    std::mutex mutex_; ///< guards put_, levels being filled, and those below
    TileCount count_;
};

TilePyramid::TilePyramid(const ClassTable& classes,
                         const TilePlan& plan,
                         const std::filesystem::path& beside)
    : classes_{classes}, plan_{plan} {
    const auto add = [&](Levels& levels, int zoom) {
        levels.emplace(
            std::piecewise_construct, std::forward_as_tuple(zoom), std::forward_as_tuple(beside));
    };
    for (int zoom = source_zoom; zoom >= plan.min_zoom; --zoom) {
        if (zoom >= directions_from_zoom) {
            add(directed_, zoom);
        }
        if (plan.min_zoom < directions_from_zoom) {
            add(both_, zoom);
        }
    }
}

TileCount TilePyramid::update(const TileSource& source,
                              const std::vector<TileId>& changed,
                              const PutTile& put,
                              const Progress& progress) {
    return Update{*this, source, put, progress}.run(changed);
}

TileCount make_vector_tiles(const TileSource& source,
                            const ClassTable& classes,
                            const TilePlan& plan,
                            const PutTile& put,
                            const Progress& progress) {
    return TilePyramid{classes, plan, source.segments.beside()}.update(
        source,
        source.segments.tiles(),
        [&](const TileId& tile, std::string_view bytes) {
            if (!bytes.empty()) {
                put(tile, bytes);
            }
        },
        progress);
}

} // namespace macadam
