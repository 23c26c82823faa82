#pragma once

#include "mapping/network/road_network.hpp"
#include "storage/networks/osm_tags.hpp"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace macadam {

enum class OsmKind : std::uint8_t { node, way, relation };

/// Of a relation.
struct OsmMember {
    OsmKind kind;
    std::int64_t id;
    std::string_view role;
};

/// A turn rule with the way that it is for.
struct TurnOutOfWay {
    std::int64_t from_way;
    TurnRule rule;
};

/// The turns that a relation of OSM forbids to cars, or of which it leaves only one: those of type
/// restriction over one node, from one way or to one, that hold at all hours. None for other
/// relations.
std::vector<TurnOutOfWay> turns_in(const OsmTags& tags, std::span<const OsmMember> members);

} // namespace macadam
