#include "mapping/network/speed_limits.hpp"

#include <algorithm>
#include <iterator>

namespace macadam {
namespace {

constexpr double other_kmh = 100;

struct ClassLimit {
    std::string_view highway;
    double kmh;
};

// Most common limits among the countries of OSM wiki, "Default speed limits": 130 km/h on
// motorways, 100 to 110 between towns, 50 in towns, 20 in living streets. The wiki gives no limits
// per class; the purpose of a class (Key:highway) determines which one applies.
constexpr ClassLimit class_limits[] = {
    {"motorway", 130},
    {"motorway_link", 110},
    {"trunk", 110},
    {"trunk_link", 100},
    {"primary", 100},
    {"secondary", 100},
    {"tertiary", 100},
    {"unclassified", 100},
    {"residential", 50},
    {"living_street", 20},
    {"service", 50},
    {"track", 50},
};

} // namespace

std::uint16_t usual_speed_limit_cmps(std::string_view highway) {
    constexpr double cmps_per_kmh = 100 / 3.6;
    const auto* const found =
        std::find_if(std::begin(class_limits), std::end(class_limits), [&](const auto& limit) {
            return limit.highway == highway;
        });
    const double kmh = found == std::end(class_limits) ? other_kmh : found->kmh;
    return static_cast<std::uint16_t>(kmh * cmps_per_kmh + 0.5);
}

} // namespace macadam
