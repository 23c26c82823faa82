#include "app/tiles/tile_drawing.hpp"

#include "mapping/tiles/tile_generalisation.hpp"
#include "storage/files/gzip.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace macadam {
namespace {

constexpr double own_share = 0.8; // share of a tile's bytes; the rest is for other tiles' parts

template <typename Item>
std::vector<const Item*> pointers_to(const std::vector<Item>& items) {
    std::vector<const Item*> pointers;
    pointers.reserve(items.size());
    for (const auto& item : items) {
        pointers.push_back(&item);
    }
    return pointers;
}

} // namespace

/// Returns a tile's layers with those of its background, gzipped.
std::string TileDrawing::with_ground(const TileId& tile, const std::string& roads) const {
    if (source_->background) {
        if (auto packed = gzipped(source_->background(tile) + roads);
            packed.size() <= plan_->max_bytes) {
            return packed;
        }
    }
    return gzipped(roads);
}

DrawnTile TileDrawing::ground(const TileId& tile) const {
    if (source_->background) {
        if (const auto bytes = source_->background(tile); !bytes.empty()) {
            if (auto packed = gzipped(bytes); packed.size() <= plan_->max_bytes) {
                return {std::move(packed)};
            }
        }
    }
    return {};
}

DrawnTile TileDrawing::segments(const TileId& tile,
                                const std::vector<const TileSegment*>& segments) const {
    int steps = 0;
    for (const auto detail : {SegmentDetail::full, SegmentDetail::less}) {
        const auto bytes = vector_tile(tile, segments, detail, context());
        if (bytes.empty()) { // near the tile, but outside of it in tile units
            return ground(tile);
        }
        if (auto packed = with_ground(tile, bytes); packed.size() <= plan_->max_bytes) {
            return {std::move(packed), steps};
        }
        ++steps;
    }
    return own_parts(tile, segments, steps);
}

DrawnTile TileDrawing::own_parts(const TileId& tile,
                                 const std::vector<const TileSegment*>& segments,
                                 int steps_before) const {
    std::vector<TileSegment> own;
    for (const auto* const segment : segments) {
        if (tile_at(middle_of(*segment), tile.zoom) == tile) {
            own.push_back(*segment);
        }
    }
    const auto [parts, steps] = fitted(tile, parts_of(own, *classes_));
    const auto bytes = vector_tile(tile, pointers_to(parts), context());
    return bytes.empty() ? ground(tile) : DrawnTile{with_ground(tile, bytes), steps_before + steps};
}

DrawnTile TileDrawing::parts(const TileId& tile,
                             const std::vector<RoadPart>& own,
                             const std::vector<RoadPart>& others) const {
    auto drawn = pointers_to(own);
    std::ranges::copy(pointers_to(others), std::back_inserter(drawn));
    std::ranges::sort(drawn, {}, [](const RoadPart* part) { return part->first; });
    const auto bytes = vector_tile(tile, drawn, context());
    if (bytes.empty()) {
        return ground(tile);
    }
    if (auto packed = with_ground(tile, bytes); packed.size() <= plan_->max_bytes) {
        return {std::move(packed)};
    }
    const auto own_bytes = vector_tile(tile, pointers_to(own), context());
    return own_bytes.empty() ? ground(tile) : DrawnTile{with_ground(tile, own_bytes), 1};
}

bool TileDrawing::fits(const TileId& tile, const std::vector<RoadPart>& parts) const {
    const auto limit = own_share * static_cast<double>(plan_->max_bytes);
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

FittedParts TileDrawing::fitted(const TileId& tile, std::vector<RoadPart> parts) const {
    constexpr int last_step = 16; // one square holds the tile, and one part is left
    for (int step = 0;; ++step) {
        parts = generalised(std::move(parts), generalisation_at(tile.zoom, step), *classes_);
        if (step == last_step || fits(tile, parts)) {
            return {std::move(parts), step};
        }
    }
}

} // namespace macadam
