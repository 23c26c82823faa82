#include "mapping/simulation/unused_rules.hpp"

#include "mapping/analysis/network_summary.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace macadam {
namespace {

template <typename Is>
bool is_any_way(const RoadNetwork& roads, Is is) {
    for (std::uint32_t i = 0; i < way_count(roads); ++i) {
        if (is(way_at(roads, i))) {
            return true;
        }
    }
    return false;
}

bool is_class(const std::string& highway, const RoadNetwork& roads) {
    return highway == "road" || road_kind(highway) != "other" ||
           is_any_way(roads, [&](const WayView& way) { return way.highway == highway; });
}

std::vector<std::string> idle_words(const RoadRule& rule, const RoadNetwork& roads) {
    std::vector<std::string> words;
    for (const auto& highway : rule.highways) {
        if (!is_class(highway, roads)) {
            words.push_back(fmt::format("no road has the class '{}'", highway));
        }
    }
    if (rule.way_id &&
        !is_any_way(roads, [&](const WayView& way) { return way.id == *rule.way_id; })) {
        words.push_back(fmt::format("no road has the way_id '{}'", *rule.way_id));
    }
    if (!rule.name.empty() &&
        !is_any_way(roads, [&](const WayView& way) { return way.name == rule.name; })) {
        words.push_back(fmt::format("no road has the name '{}'", rule.name));
    }
    return words;
}

} // namespace

std::vector<std::string> unused_rules(const FleetScenario& recipe, const RoadNetwork& roads) {
    std::vector<std::string> all;
    const auto add = [&](const std::string& words) {
        if (std::ranges::find(all, words) == all.end()) {
            all.push_back(words);
        }
    };
    for (const auto& [highway, speed_kmh] : recipe.driving.speed_kmh) {
        if (!is_class(highway, roads)) {
            add(fmt::format("no road has the class '{}'", highway));
        }
    }
    for (const auto& rule : recipe.roads) {
        std::ranges::for_each(idle_words(rule, roads), add);
    }
    return all;
}

} // namespace macadam
