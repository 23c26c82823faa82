#include "storage/networks/osm_turn_restrictions.hpp"

#include <algorithm>

namespace macadam {
namespace {

// Source of keys, values and roles: OSM wiki, page Relation:restriction.

constexpr std::string_view forbidden_turns[] = {
    "no_left_turn", "no_right_turn", "no_straight_on", "no_u_turn", "no_entry", "no_exit"};
constexpr std::string_view only_turns[] = {
    "only_left_turn", "only_right_turn", "only_straight_on", "only_u_turn"};
constexpr std::string_view cars[] = {"motorcar", "motor_vehicle", "vehicle"};

/// Tests whether cars are in a list such as `psv;motorcar`.
bool names_cars(std::string_view list) {
    constexpr std::string_view between_words = "; ";
    while (!list.empty()) {
        const auto end = std::min(list.find_first_of(between_words), list.size());
        if (is_one_of(list.substr(0, end), cars)) {
            return true;
        }
        list.remove_prefix(std::min(end + 1, list.size()));
    }
    return false;
}

/// Restriction that applies to cars; "" if there is none, or only at certain hours.
std::string_view said_of_cars(const OsmTags& tags) {
    for (const char* const key : {"restriction:motorcar", "restriction:motor_vehicle"}) {
        if (const auto own = value(tags, key); !own.empty()) {
            return own;
        }
    }
    const bool at_hours = !value(tags, "hour_on").empty() || !value(tags, "day_on").empty();
    return at_hours || names_cars(value(tags, "except")) ? "" : value(tags, "restriction");
}

std::vector<std::int64_t>
ids_of(std::span<const OsmMember> members, OsmKind kind, std::string_view role) {
    std::vector<std::int64_t> ids;
    for (const auto& member : members) {
        if (member.kind == kind && member.role == role) {
            ids.push_back(member.id);
        }
    }
    return ids;
}

} // namespace

std::vector<TurnOutOfWay> turns_in(const OsmTags& tags, std::span<const OsmMember> members) {
    const auto said = value(tags, "type") == "restriction" ? said_of_cars(tags) : "";
    const bool only = is_one_of(said, only_turns);
    const auto nodes = ids_of(members, OsmKind::node, "via");
    const bool over_ways = !ids_of(members, OsmKind::way, "via").empty();
    if ((!only && !is_one_of(said, forbidden_turns)) || nodes.size() != 1 || over_ways) {
        return {};
    }
    const auto all_from = ids_of(members, OsmKind::way, "from");
    const auto all_to = ids_of(members, OsmKind::way, "to");
    if (all_from.size() > 1 && all_to.size() > 1) {
        return {}; // only no_entry and no_exit may have several ways, on one side
    }
    std::vector<TurnOutOfWay> turns;
    for (const auto from : all_from) {
        for (const auto to : all_to) {
            turns.push_back({from, {nodes.front(), to, only ? 1 : 0}});
        }
    }
    return turns;
}

} // namespace macadam
