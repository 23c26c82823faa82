#include "edited_network.hpp"

#include "mapping/network/build_network.hpp"
#include "mapping/passes/chunk_trace.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <ranges>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace macadam::testing {
namespace {

using Found = std::vector<EditedWay>::iterator;

Found find(EditedNetwork& network, std::int64_t way_id) {
    const auto found = std::ranges::find(
        network.ways, way_id, [](const EditedWay& edited) { return edited.way.id; });
    if (found == network.ways.end()) {
        throw std::logic_error{"no such way"};
    }
    return found;
}

std::ptrdiff_t at(std::size_t i) {
    return static_cast<std::ptrdiff_t>(i);
}

GeoPoint moved(const GeoPoint& place, double east_m, double north_m) {
    constexpr double m_per_deg = 111'200; // about
    return {place.lat_deg + north_m / m_per_deg,
            place.lon_deg +
                east_m / (m_per_deg * std::cos(place.lat_deg * std::numbers::pi / 180))};
}

/// Each point to the right of the line's course there.
std::vector<GeoPoint> aside(const std::vector<GeoPoint>& line, double aside_m) {
    std::vector<GeoPoint> result;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const auto& behind = line[i == 0 ? 0 : i - 1];
        const auto& ahead = line[std::min(i + 1, line.size() - 1)];
        const double right_rad = (course_deg(behind, ahead) + 90) * std::numbers::pi / 180;
        result.push_back(
            moved(line[i], aside_m * std::sin(right_rad), aside_m * std::cos(right_rad)));
    }
    return result;
}

std::vector<std::int64_t> new_nodes(std::size_t count, std::int64_t first) {
    std::vector<std::int64_t> ids;
    for (std::size_t i = 0; i < count; ++i) {
        ids.push_back(first + static_cast<std::int64_t>(i));
    }
    return ids;
}

bool may_drive(Oneway oneway, bool forward) {
    return oneway != (forward ? Oneway::backward : Oneway::forward);
}

/// A place in driving direction.
struct Place {
    std::int64_t way_id;
    bool forward;
    double station_m;
};

/// Where the middle of each step of the old ways is now.
using Truth = std::map<std::tuple<std::int64_t, std::size_t, bool>, Place>;

Truth truth_of(const EditedNetwork& network, const RoadNetwork& roads) {
    std::map<std::int64_t, std::uint32_t> numbers;
    for (std::uint32_t i = 0; i < way_count(roads); ++i) {
        numbers[way_at(roads, i).id] = i;
    }
    Truth truth;
    for (const auto& [way, steps] : network.ways) {
        const auto view = way_at(roads, numbers.at(way.id));
        if (view.line.size() != way.line.size()) {
            continue; // it has a point twice: not followed here
        }
        for (std::size_t i = 0; i < steps.size(); ++i) {
            const double middle_m = (view.along_m[i] + view.along_m[i + 1]) / 2;
            for (const bool forward : {true, false}) {
                if (steps[i] && may_drive(way.oneway, forward)) {
                    truth[{steps[i]->way_id, steps[i]->step, forward != steps[i]->reversed}] = {
                        way.id, forward, station_m(forward, middle_m)};
                }
            }
        }
    }
    return truth;
}

std::optional<Place> place_in(const NetworkChange& change, const Place& old) {
    if (std::ranges::binary_search(change.kept, old.way_id)) {
        return old;
    }
    for (const auto& [before, after] : change.same) {
        if (before.way_id == old.way_id && before.forward == old.forward &&
            before.from_station_m <= old.station_m && old.station_m < before.to_station_m) {
            const double share = (old.station_m - before.from_station_m) /
                                 (before.to_station_m - before.from_station_m);
            return Place{after.way_id,
                         after.forward,
                         std::lerp(after.from_station_m, after.to_station_m, share)};
        }
    }
    return std::nullopt;
}

} // namespace

EditedNetwork edited(const std::vector<Way>& ways) {
    EditedNetwork network;
    for (const auto& way : ways) {
        EditedWay whole{way, {}};
        for (std::size_t i = 0; i + 1 < way.line.size(); ++i) {
            whole.steps.push_back(StepOrigin{way.id, i, false});
        }
        network.ways.push_back(std::move(whole));
    }
    return network;
}

std::vector<Way> ways_of(const EditedNetwork& network) {
    std::vector<Way> ways;
    std::ranges::transform(network.ways, std::back_inserter(ways), &EditedWay::way);
    return ways;
}

void split(EditedNetwork& network, std::int64_t way_id, std::size_t point, std::int64_t second_id) {
    auto& first = *find(network, way_id);
    auto second = first;
    second.way.id = second_id;
    second.way.node_ids.erase(second.way.node_ids.begin(), second.way.node_ids.begin() + at(point));
    second.way.line.erase(second.way.line.begin(), second.way.line.begin() + at(point));
    second.steps.erase(second.steps.begin(), second.steps.begin() + at(point));
    first.way.node_ids.resize(point + 1);
    first.way.line.resize(point + 1);
    first.steps.resize(point);
    network.ways.push_back(std::move(second));
}

void merge(EditedNetwork& network, std::int64_t first_id, std::int64_t second_id) {
    const auto second = *find(network, second_id);
    erase(network, second_id);
    auto& first = *find(network, first_id);
    first.way.node_ids.insert(
        first.way.node_ids.end(), second.way.node_ids.begin() + 1, second.way.node_ids.end());
    first.way.line.insert(first.way.line.end(), second.way.line.begin() + 1, second.way.line.end());
    first.steps.insert(first.steps.end(), second.steps.begin(), second.steps.end());
}

void renumber(EditedNetwork& network, std::int64_t way_id, std::int64_t new_id) {
    find(network, way_id)->way.id = new_id;
}

void reverse(EditedNetwork& network, std::int64_t way_id) {
    auto& [way, steps] = *find(network, way_id);
    std::ranges::reverse(way.node_ids);
    std::ranges::reverse(way.line);
    std::ranges::reverse(steps);
    for (auto& step : steps) {
        if (step) {
            step->reversed = !step->reversed;
        }
    }
    if (way.oneway != Oneway::no) {
        way.oneway = way.oneway == Oneway::forward ? Oneway::backward : Oneway::forward;
    }
}

void erase(EditedNetwork& network, std::int64_t way_id) {
    network.ways.erase(find(network, way_id));
}

void nudge(EditedNetwork& network,
           const std::function<GeoPoint(std::int64_t, const GeoPoint&)>& moved) {
    for (auto& [way, steps] : network.ways) {
        for (std::size_t i = 0; i < way.line.size(); ++i) {
            way.line[i] = moved(way.node_ids[i], way.line[i]);
        }
    }
}

void rebuild_aside(EditedNetwork& network,
                   std::int64_t way_id,
                   double aside_m,
                   std::int64_t first_node_id) {
    auto& [way, steps] = *find(network, way_id);
    way.line = aside(way.line, aside_m);
    way.node_ids = new_nodes(way.line.size(), first_node_id);
    std::ranges::fill(steps, std::nullopt);
}

void add_parallel(EditedNetwork& network,
                  std::int64_t way_id,
                  double aside_m,
                  std::int64_t new_id,
                  std::int64_t first_node_id) {
    auto copy = *find(network, way_id);
    copy.way.id = new_id;
    network.ways.push_back(std::move(copy));
    rebuild_aside(network, new_id, aside_m, first_node_id);
}

ChangeScore score(const std::vector<Way>& before, const EditedNetwork& after, double most_off_m) {
    const auto old_roads = build_network(before);
    const auto new_roads = build_network(ways_of(after));
    const auto change = change_between(old_roads, new_roads);
    const auto truth = truth_of(after, new_roads);
    ChangeScore sum;
    for (std::uint32_t number = 0; number < way_count(old_roads); ++number) {
        const auto way = way_at(old_roads, number);
        for (std::size_t i = 0; i + 1 < way.line.size(); ++i) {
            const double step_m = way.along_m[i + 1] - way.along_m[i];
            const double middle_m = way.along_m[i] + step_m / 2;
            for (const bool forward : {true, false}) {
                if (!may_drive(way.oneway, forward)) {
                    continue;
                }
                const auto found =
                    place_in(change, {way.id, forward, station_m(forward, middle_m)});
                const auto known = truth.find({way.id, i, forward});
                const bool is_there = known != truth.end();
                const bool is_right =
                    is_there == found.has_value() &&
                    (!found ||
                     (found->way_id == known->second.way_id &&
                      found->forward == known->second.forward &&
                      std::abs(found->station_m - known->second.station_m) <= most_off_m));
                (is_right ? sum.right_m : found ? sum.wrong_m : sum.lost_m) += step_m;
            }
        }
    }
    return sum;
}

} // namespace macadam::testing
