#include "storage/networks/osm_tags.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

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

std::string_view access_of(const OsmTags& tags) {
    for (const char* const key : {"motorcar", "motor_vehicle", "vehicle", "access"}) {
        if (const auto access = value(tags, key); !access.empty()) {
            return access;
        }
    }
    return {};
}

constexpr double mps_per_kmh = 1 / 3.6;
constexpr double mps_per_mph = 0.44704;
constexpr double no_limit_kmh = 250; // usual electronic limit of fast cars
constexpr double walking_kmh = 7;    // upper value of German courts; OSM wiki, Key:maxspeed

/// Speed in m/s; 0 if the text is not a speed.
double speed_mps(std::string_view text) {
    if (text == "none") {
        return no_limit_kmh * mps_per_kmh;
    }
    if (text == "walk") {
        return walking_kmh * mps_per_kmh;
    }
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || !(number > 0 && number <= no_limit_kmh)) {
        return 0;
    }
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    return text.empty() || text == "km/h" || text == "kmh" || text == "kph" ? number * mps_per_kmh
           : text == "mph"                                                  ? number * mps_per_mph
                                                                            : 0;
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
    if (!oneway.empty()) { // no, and values that depend on time: reversible, alternating
        return Oneway::no;
    }
    const auto junction = value(tags, "junction");
    const bool implied =
        junction == "roundabout" || junction == "circular" || value(tags, "highway") == "motorway";
    return implied ? Oneway::forward : Oneway::no;
}

std::uint16_t speed_limit_cmps_of(const OsmTags& tags) {
    constexpr double cm_per_m = 100;
    const double either_mps = speed_mps(value(tags, "maxspeed"));
    const double of_one_mps = std::max(speed_mps(value(tags, "maxspeed:forward")),
                                       speed_mps(value(tags, "maxspeed:backward")));
    return static_cast<std::uint16_t>(std::lround(std::max(either_mps, of_one_mps) * cm_per_m));
}

std::string_view name_of(const OsmTags& tags) {
    const auto name = value(tags, "name");
    return name.empty() ? value(tags, "ref") : name;
}

bool is_car_class(std::string_view highway) {
    return is_one_of(highway, car_classes) || highway == "track";
}

bool is_for_others(std::string_view highway) {
    return is_one_of(highway, other_classes);
}

} // namespace macadam
