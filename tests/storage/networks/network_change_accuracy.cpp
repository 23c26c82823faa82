#include "mapping/conflation/network_conflation.hpp"

#include "storage/networks/network_reader.hpp"
#include "support/program/places.hpp"
#include "support/roads/edited_network.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <random>
#include <set>

namespace macadam {
namespace {

using testing::ChangeScore;
using testing::EditedNetwork;

constexpr const char* places[] = {
    "andorra", "baltimore", "harrisburg", "krems", "liechtenstein", "monaco", "stockholm"};

std::vector<Way> extract(const std::string& name) {
    return read_network(testing::source_folder() + "/sample_data/networks/" + name + ".osm.pbf");
}

std::vector<std::int64_t> ids_of(const EditedNetwork& network) {
    std::vector<std::int64_t> ids;
    for (const auto& edited : network.ways) {
        ids.push_back(edited.way.id);
    }
    return ids;
}

constexpr std::int64_t new_ids = 10'000'000'000; // beyond OSM's own

/// Nodes at which two ways end and nothing else is, and which ways.
std::map<std::int64_t, std::vector<std::int64_t>> joints_of(const EditedNetwork& network) {
    std::map<std::int64_t, std::vector<std::int64_t>> ends;
    std::map<std::int64_t, int> met;
    for (const auto& [way, steps] : network.ways) {
        for (const auto node : way.node_ids) {
            ++met[node];
        }
        ends[way.node_ids.front()].push_back(way.id);
        ends[way.node_ids.back()].push_back(way.id);
    }
    std::erase_if(ends, [&](const auto& end) {
        return end.second.size() != 2 || met[end.first] != 2 || end.second[0] == end.second[1];
    });
    return ends;
}

const testing::EditedWay& way_in(const EditedNetwork& network, std::int64_t id) {
    return *std::ranges::find(
        network.ways, id, [](const testing::EditedWay& edited) { return edited.way.id; });
}

/// How often mappers did what; shares of ways.
struct Habits {
    double split = 0.05;
    double merged = 0.05;
    double renumbered = 0.2;
    double reversed = 0.1;
    double erased = 0.03;
    double rebuilt = 0.02;
    double doubled = 0.02;
    double point_sd_m = 0; ///< by which each point is moved, per axis
    double area_sd_m = 0;  ///< and all points of a neighbourhood alike
};

/// Waves of some hundred metres: an aerial picture that lies elsewhere.
double area_shift(double lat_deg, double lon_deg) {
    constexpr double rad_per_deg = 1000; // a wave of 700 m of latitude
    return std::sin(lat_deg * rad_per_deg) + std::sin(0.7 * lon_deg * rad_per_deg + 1);
}

GeoPoint moved(std::int64_t node, const GeoPoint& place, const Habits& habits) {
    std::mt19937_64 random{static_cast<std::uint64_t>(node)};
    std::normal_distribution<double> metres{0, habits.point_sd_m > 0 ? habits.point_sd_m : 1e-9};
    const double east_m =
        metres(random) + habits.area_sd_m * area_shift(place.lat_deg, place.lon_deg);
    const double north_m =
        metres(random) + habits.area_sd_m * area_shift(place.lon_deg, place.lat_deg);
    constexpr double m_per_deg = 111'200; // about
    return {place.lat_deg + north_m / m_per_deg,
            place.lon_deg +
                east_m / (m_per_deg * std::cos(place.lat_deg * std::numbers::pi / 180))};
}

EditedNetwork edited_at_random(const std::vector<Way>& ways, const Habits& habits) {
    std::mt19937_64 random{7};
    const auto happens = [&](double share) {
        return static_cast<double>(random() % 1'000'000) < share * 1e6;
    };
    auto network = testing::edited(ways);
    auto next = new_ids;
    if (habits.point_sd_m > 0 || habits.area_sd_m > 0) {
        testing::nudge(network, [&](std::int64_t node, const GeoPoint& place) {
            return moved(node, place, habits);
        });
    }
    for (const auto id : ids_of(network)) {
        if (happens(habits.erased)) {
            testing::erase(network, id);
        } else if (happens(habits.rebuilt)) {
            testing::rebuild_aside(network, id, 30, next += 10'000);
        } else if (happens(habits.doubled)) {
            testing::add_parallel(network, id, 12, next + 1, next + 2);
            next += 10'000;
        }
    }
    std::set<std::int64_t> merged;
    for (const auto& [node, both] : joints_of(network)) {
        if (merged.contains(both[0]) || merged.contains(both[1])) {
            continue;
        }
        const auto& a = way_in(network, both[0]).way;
        const auto& b = way_in(network, both[1]).way;
        if (a.node_ids.back() == node && b.node_ids.front() == node && a.oneway == b.oneway &&
            happens(habits.merged)) {
            merged.insert(both.begin(), both.end());
            testing::merge(network, both[0], both[1]);
        }
    }
    for (const auto id : ids_of(network)) {
        const auto points = way_in(network, id).way.line.size();
        if (points > 2 && happens(habits.split)) {
            testing::split(network, id, 1 + random() % (points - 2), ++next);
        }
    }
    for (const auto id : ids_of(network)) {
        if (happens(habits.reversed)) {
            testing::reverse(network, id);
        }
        if (happens(habits.renumbered)) {
            testing::renumber(network, id, ++next);
        }
    }
    return network;
}

ChangeScore score_of_all(const char* what, const Habits& habits, double most_off_m = 5) {
    ChangeScore sum;
    for (const auto* place : places) {
        const auto ways = extract(place);
        const auto found = testing::score(ways, edited_at_random(ways, habits), most_off_m);
        sum.right_m += found.right_m;
        sum.wrong_m += found.wrong_m;
        sum.lost_m += found.lost_m;
    }
    const double all_m = sum.right_m + sum.wrong_m + sum.lost_m;
    std::printf("%-44s %6.0f km  right %7.3f %%  wrong %7.3f %%  lost %7.3f %%\n",
                what,
                all_m / 1000,
                100 * sum.right_m / all_m,
                100 * sum.wrong_m / all_m,
                100 * sum.lost_m / all_m);
    return {sum.right_m / all_m, sum.wrong_m / all_m, sum.lost_m / all_m};
}

TEST(NetworkChangeAccuracy, OfAYearOfMapping) {
    const auto found = score_of_all("edits as of a year", {});
    EXPECT_GE(found.right_m, 0.995);
    EXPECT_LE(found.wrong_m, 0.002);
}

TEST(NetworkChangeAccuracy, OfAMapWithAllNumbersNew) {
    const auto found =
        score_of_all("all ways renumbered, half reversed", {.renumbered = 1, .reversed = 0.5});
    EXPECT_GE(found.right_m, 0.995);
    EXPECT_LE(found.wrong_m, 0.002);
}

TEST(NetworkChangeAccuracy, OfAMapDrawnAfterAnotherPicture) {
    constexpr Habits habits{.renumbered = 1, .reversed = 0.5, .point_sd_m = 0.5, .area_sd_m = 3};
    const auto near = score_of_all("the same, areas moved by 3 m per axis", habits);
    EXPECT_GE(near.right_m, 0.95);
    const auto far = score_of_all("the same, right if within 10 m", habits, 10);
    EXPECT_GE(far.right_m, 0.99);
    EXPECT_LE(far.wrong_m, 0.005);
}

TEST(NetworkChangeAccuracy, OfAMapWhosePointsWereAllMoved) {
    const auto one = score_of_all("the same, each point moved by 1 m per axis",
                                  {.renumbered = 1, .reversed = 0.5, .point_sd_m = 1});
    EXPECT_GE(one.right_m, 0.99);
    EXPECT_LE(one.wrong_m, 0.005);
    const auto two = score_of_all("the same, each point moved by 2 m per axis",
                                  {.renumbered = 1, .reversed = 0.5, .point_sd_m = 2});
    EXPECT_GE(two.right_m, 0.94);
    EXPECT_LE(two.wrong_m, 0.03);
}

} // namespace
} // namespace macadam
