#pragma once

#include "mapping/network/road_network.hpp"
#include "storage/networks/osm_tags.hpp"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace macadam {

enum class OsmKind : std::uint8_t { node, way, relation };

/// Member of a relation.
struct OsmMember {
    OsmKind kind;
    std::int64_t id;
    std::string_view role;
};

/// Turn rule with the way to which it applies.
struct TurnOutOfWay {
    std::int64_t from_way;
    TurnRule rule;
};

/// Extracts the turn rules for cars from an OSM relation of type restriction, no_* and only_*, if
/// it applies over one node, has a single from or to way, and holds at all hours. Empty for other
/// relations.
std::vector<TurnOutOfWay> turns_in(const OsmTags& tags, std::span<const OsmMember> members);

} // namespace macadam
