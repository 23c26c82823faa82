#include "storage/osm_tags.hpp"

#include <algorithm>
#include <iterator>

namespace macadam {

namespace {

// Source of keys and values: OSM wiki, pages Key:highway, Key:access, Key:oneway.

constexpr std::string_view car_classes[] = {
    "motorway",
    "motorway_link",
    "trunk",
    "trunk_link",
    "primary",
    "primary_link",
    "secondary",
    "secondary_link",
    "tertiary",
    "tertiary_link",
    "unclassified",
    "residential",
    "living_street",
    "service",
    "road",
};

constexpr std::string_view other_classes[] = {
    "footway",
    "cycleway",
    "path",
    "pedestrian",
    "steps",
    "bridleway",
    "corridor",
    "platform",
    "elevator",
    "via_ferrata",
    "construction",
    "proposed",
    "abandoned",
    "raceway",
};

constexpr std::string_view shut_values[] = {
    "no",
    "agricultural",
    "forestry",
    "agricultural;forestry",
    "emergency",
    "bus",
    "psv",
    "military",
    "hov",
    "use_sidepath",
};

template <std::size_t count>
bool is_one_of(std::string_view value, const std::string_view (&values)[count]) {
    return std::find(std::begin(values), std::end(values), value) != std::end(values);
}

std::string_view value(const OsmTags& tags, const char* key) {
    const char* const found = tags(key);
    return found == nullptr ? std::string_view{} : found;
}

std::string_view access_of(const OsmTags& tags) {
    for (const char* const key : {"motorcar", "motor_vehicle", "vehicle", "access"}) {
        if (const auto access = value(tags, key); !access.empty()) {
            return access;
        }
    }
    return {};
}

} // namespace

bool is_drivable(const OsmTags& tags) {
    const auto highway = value(tags, "highway");
    const bool paved_track = highway == "track" && value(tags, "tracktype") == "grade1";
    if (!is_one_of(highway, car_classes) && !paved_track) {
        return false;
    }
    if (value(tags, "area") == "yes") {
        return false;
    }
    const auto access = access_of(tags);
    const bool yard = highway == "service" || paved_track;
    return !is_one_of(access, shut_values) && !(yard && access == "private");
}

Oneway oneway_of(const OsmTags& tags) {
    const auto oneway = value(tags, "oneway");
    if (oneway == "yes" || oneway == "1" || oneway == "true") {
        return Oneway::forward;
    }
    if (oneway == "-1" || oneway == "reverse") {
        return Oneway::backward;
    }
    if (!oneway.empty()) { // no, and what changes by the hour: reversible, alternating
        return Oneway::no;
    }
    const auto junction = value(tags, "junction");
    const bool implied =
        junction == "roundabout" || junction == "circular" || value(tags, "highway") == "motorway";
    return implied ? Oneway::forward : Oneway::no;
}

std::string_view name_of(const OsmTags& tags) {
    const auto name = value(tags, "name");
    return name.empty() ? value(tags, "ref") : name;
}

bool is_for_others(std::string_view highway) {
    return is_one_of(highway, other_classes);
}

} // namespace macadam
