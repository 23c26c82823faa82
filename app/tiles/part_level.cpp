#include "app/tiles/part_level.hpp"

#include "mapping/tiles/tile_areas.hpp"

#include <string>

namespace macadam {

void PartLevel::set(const TileId& tile, const std::vector<RoadPart>& parts) {
    std::string bytes;
    for (const auto& part : parts) {
        append_to(bytes, part);
    }
    if (bytes == parts_.read(tile)) {
        return;
    }
    parts_.put(tile, bytes);
    changed_.insert(tile);
    count_entries(tile, -1);
    auto& entered = entered_[tile];
    entered.clear();
    for (const auto& part : parts) {
        each_tile_of(
            box_of(part.line), tile.zoom, 0, [&](const TileId& each) { entered.insert(each); });
    }
    count_entries(tile, 1);
    if (entered.empty()) {
        entered_.erase(tile);
    }
}

void PartLevel::count_entries(const TileId& tile, int by) {
    for (const auto& each : entered_[tile]) {
        entered_by_changed_.insert(each);
        if ((entries_[each] += by) == 0) {
            entries_.erase(each);
        }
    }
}

std::vector<TileId> PartLevel::touched() const {
    std::set<TileId> touched;
    for (const auto* const tiles : {&changed_, &entered_by_changed_}) {
        for (const auto& tile : *tiles) {
            each_tile_around(tile, [&](const TileId& each) { touched.insert(each); });
        }
    }
    return {touched.begin(), touched.end()};
}

void PartLevel::settle() {
    changed_.clear();
    entered_by_changed_.clear();
    parts_.compact();
}

} // namespace macadam
