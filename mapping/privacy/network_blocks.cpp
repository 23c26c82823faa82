#include "mapping/privacy/network_blocks.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double longest_block_m = 500;
constexpr std::uint64_t blocks_per_edge = 65'536; // no way is longer than 4294 km

} // namespace

std::uint64_t NetworkBlocks::block_of(const SegmentKey& segment) const {
    const auto ways = roads_.ways.first(way_count(roads_));
    const auto way = std::ranges::lower_bound(ways, segment.way_id, {}, &PackedWay::id);
    if (way == ways.end() || way->id != segment.way_id) {
        return 0;
    }
    const auto view = way_at(roads_, static_cast<std::uint32_t>(way - ways.begin()));
    const auto links = roads_.links.subspan(view.first_link, view.past_link - view.first_link);
    const auto after =
        std::ranges::upper_bound(links, segment.index, {}, &PackedLink::first_segment);
    if (after == links.begin()) {
        return 0;
    }
    const auto number = view.first_link + static_cast<std::uint32_t>(after - links.begin()) - 1;
    const auto link = link_at(roads_, LinkId{number});
    const auto along = segment.index - link.first_segment;
    if (along >= link.segments) {
        return 0;
    }
    const auto parts = static_cast<std::uint64_t>(
        std::max(1.0, std::ceil((link.to_m - link.from_m) / longest_block_m)));
    const auto part = along * parts / link.segments;
    const auto edge = static_cast<std::uint64_t>(edge_of(LinkId{number}, segment.forward));
    return 1 + edge * blocks_per_edge + part;
}

} // namespace macadam
