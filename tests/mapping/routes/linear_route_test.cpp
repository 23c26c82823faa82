#include "mapping/network/build_network.hpp"
#include "mapping/routes/linear_route.hpp"

#include "estimator/common/error.hpp"
#include "mapping/analysis/exclusion.hpp"
#include "mapping/routes/line_matching.hpp"
#include "mapping/routes/shortest_path.hpp"
#include "support/roads/road_art.hpp"
#include "support/roads/town.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <random>

namespace macadam {
namespace {

using ::testing::HasSubstr;
using testing::road_art;
using testing::RoadArt;
using ::testing::SizeIs;

/// The words of the InputError that `call` throws; "" if it throws none.
std::string refusal_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

/// A main road of two ways with a side road; C-D is drawn against it.
RoadArt main_road() {
    auto art = road_art(R"(
        A---------B---------C---------D
                  |
                  E
    )",
                        10,
                        {"AB", "BC", "DC", "BE>"});
    for (auto& way : art.ways) {
        way.name = way.id == 4 ? "Side Road" : "Main Road";
        way.highway = "residential";
    }
    art.roads = build_network(art.ways, 20);
    return art;
}

double length_of(const std::vector<GeoPoint>& line) {
    double sum_m = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        sum_m += distance_m(line[i - 1], line[i]);
    }
    return sum_m;
}

TEST(LinearRoute, FallsIntoThePiecesOfItsSegmentsInDrivingOrder) {
    const auto art = main_road();
    for (const bool forward : {true, false}) {
        const auto road = route_along_way(art.roads, 2, 25, 75, forward);
        const auto pieces = pieces_of(art.roads, road);
        const auto whole =
            segments_of(art.roads, edge_of(link_of(edge_between(art, 'B', 'C')), true));
        ASSERT_THAT(pieces, SizeIs(3)); // 20-40, 40-60, 60-80
        EXPECT_NEAR(length_m(road), 50, 1e-6);
        for (std::size_t i = 0; i < 3; ++i) {
            const auto& segment = whole[forward ? i + 1 : 3 - i];
            EXPECT_EQ(pieces[i].segment, (SegmentKey{2, forward, segment.key.index}));
            EXPECT_NEAR(pieces[i].way_from_m, std::max(25.0, segment.from_m), 1e-6);
            EXPECT_NEAR(pieces[i].way_to_m, std::min(75.0, segment.to_m), 1e-6);
            EXPECT_NEAR(
                pieces[i].to_m - pieces[i].from_m, pieces[i].way_to_m - pieces[i].way_from_m, 1e-6);
        }
        EXPECT_THAT(ranges_of(pieces), SizeIs(1));
        EXPECT_EQ(ranges_of(pieces)[0], (SegmentRange{2, forward, 1, 4}));
    }
}

TEST(LinearRoute, RunsAgainstItsStationsWhereTheyFall) {
    const auto art = main_road();
    const auto onward = route_along_way(art.roads, 1, 20, 60, std::nullopt);
    const auto back = route_along_way(art.roads, 1, 60, 20, std::nullopt);
    const auto same = route_along_way(art.roads, 1, 20, 60, false);
    ASSERT_THAT(back.parts, SizeIs(1));
    EXPECT_EQ(back.parts[0].edge, reversed(*onward.parts[0].edge));
    EXPECT_EQ(back.parts[0].edge, same.parts[0].edge);
    EXPECT_NEAR(back.parts[0].from_m, same.parts[0].from_m, 1e-9);
    auto line = line_of(art.roads, onward, 0, 40);
    std::ranges::reverse(line);
    const auto back_line = line_of(art.roads, back, 0, 40);
    ASSERT_EQ(line.size(), back_line.size());
    for (std::size_t i = 0; i < line.size(); ++i) {
        EXPECT_NEAR(distance_m(line[i], back_line[i]), 0, 1e-3);
    }
}

TEST(LinearRoute, OfANameGoesThroughItsWaysAsMostOfThemAreDrawn) {
    const auto art = main_road();
    const auto road = route_of_named_road(art.roads, "Main Road");
    ASSERT_THAT(road.parts, SizeIs(3));
    EXPECT_EQ(road.parts[0].edge, edge_between(art, 'A', 'B'));
    EXPECT_EQ(road.parts[2].edge, edge_between(art, 'C', 'D')); // against its own way
    EXPECT_NEAR(length_of(line_of(art.roads, road, 0, length_m(road))), length_m(road), 0.01);
}

TEST(LinearRoute, RefusesRoadsThatAreNotThereOrNotOne) {
    const auto art = main_road();
    EXPECT_EQ(refusal_of([&] { route_along_way(art.roads, 99, {}, {}, {}); }),
              "the network has no way '99'");
    EXPECT_EQ(refusal_of([&] { route_of_named_road(art.roads, "main road"); }),
              "the network has no road 'main road'");
    auto ways = road_art("A---B   C---D", 10, {"AB", "CD"}).ways;
    ways[0].name = ways[1].name = "Twice";
    EXPECT_THAT(refusal_of([&] { route_of_named_road(build_network(ways, 20), "Twice"); }),
                HasSubstr("'Twice' names 2 separate roads in the network, expected one"));
}

TEST(LinearRoute, FollowsADrawnLineToItsEnds) {
    const auto art = main_road();
    for (const std::string letters : {"A2BCD", "DCB", "D3CB", "ABE", "AB", "B5C"}) {
        const auto line = testing::line_through(art, letters);
        const auto road = matched_line(art.roads, line);
        EXPECT_NEAR(length_m(road), length_of(line), 0.5) << letters;
        const auto followed_line = line_of(art.roads, road, 0, length_m(road));
        EXPECT_LT(distance_m(followed_line.front(), line.front()), 0.5) << letters;
        EXPECT_LT(distance_m(followed_line.back(), line.back()), 0.5) << letters;
    }
}

TEST(LinearRoute, ExcludesWhatLiesWithinARadius) {
    const auto art = main_road();
    const auto road = route_of_named_road(art.roads, "Main Road");
    const auto b = art.places.at('B');
    const double at_b_m = length_m(art.roads, edge_between(art, 'A', 'B'));
    const std::vector<Exclusion> point{{{b}, 15}};
    const auto ranges = excluded_ranges(art.roads, road, point);
    ASSERT_THAT(ranges, SizeIs(1));
    EXPECT_NEAR(ranges[0].from_m, at_b_m - 15, 1); // to a step
    EXPECT_NEAR(ranges[0].to_m, at_b_m + 15, 1);

    const std::vector<Exclusion> line_and_far{{{b, art.places.at('C')}, 2}, {{{0, 0}}, 9}};
    const auto long_range = excluded_ranges(art.roads, road, line_and_far);
    ASSERT_THAT(long_range, SizeIs(1));
    EXPECT_NEAR(long_range[0].to_m - long_range[0].from_m, 100 + 4, 2);
}

// --------------------------------------------------------------------------------------- routes

/// Cheapest way from the beginning of each edge to the end of each, by relaxing until nothing
/// changes: the slow road to what A* finds.
std::vector<double>
cheapest_from(const RoadNetwork& roads, EdgeId start, const std::function<double(EdgeId)>& cost) {
    std::vector<double> spent(2 * link_count(roads), std::numeric_limits<double>::infinity());
    spent[static_cast<std::size_t>(start)] = cost(start);
    for (bool changed = true; changed;) {
        changed = false;
        for (const auto edge : drivable_edges(roads)) {
            const auto outs = out_edges(roads, to_node(roads, edge));
            const bool dead_end = std::ranges::none_of(outs, [&](EdgeId next) {
                return next != reversed(edge) && may_turn(roads, edge, next);
            });
            for (const auto next : outs) {
                if (next == reversed(edge) ? !dead_end : !may_turn(roads, edge, next)) {
                    continue;
                }
                const double offer = spent[static_cast<std::size_t>(edge)] + cost(next);
                auto& best = spent[static_cast<std::size_t>(next)];
                changed = changed || offer < best - 1e-9;
                best = std::min(best, offer);
            }
        }
    }
    return spent;
}

TEST(RoadRoute, IsAsGoodAsTheBestOfAllWays) {
    const auto roads = testing::made_up_town(5);
    std::mt19937 random{3};
    for (const auto best : {RouteConfig::Best::quickest, RouteConfig::Best::shortest}) {
        const auto rate = [&](EdgeId edge) {
            return best == RouteConfig::Best::shortest ? 1.0
                                                       : 1 / speed_limit_mps(roads, link_of(edge));
        };
        const auto cost = [&](EdgeId edge) { return length_m(roads, edge) * rate(edge); };
        for (int round = 0; round < 20; ++round) {
            const auto any = [&] {
                return LinkId{static_cast<std::uint32_t>(random() % link_count(roads))};
            };
            const auto from = any(), to = any();
            if (from == to) {
                continue;
            }
            const auto middle = [&](LinkId link) {
                return place_on(roads, edge_of(link, true), length_m(roads, link) / 2);
            };
            double least = std::numeric_limits<double>::infinity();
            for (const bool out : {true, false}) {
                const auto start = edge_of(from, out);
                if (!is_drivable(roads, start)) {
                    continue;
                }
                const auto spent = cheapest_from(roads, start, cost);
                for (const bool in : {true, false}) {
                    const auto goal = edge_of(to, in);
                    least = std::min(least,
                                     spent[static_cast<std::size_t>(goal)] - cost(start) / 2 -
                                         cost(goal) / 2);
                }
            }
            const auto route = route_between(roads, middle(from), middle(to), {.best = best});
            double spent = 0;
            for (const auto& part : route.parts) {
                spent += (part.to_m - part.from_m) * rate(*part.edge);
            }
            EXPECT_NEAR(spent, least, 1e-3 * least + 0.1); // places are rounded to centimetres
        }
    }
}

TEST(RoadRoute, StaysOnOneEdgeOrGoesRoundAsOnewaysWant) {
    const auto art = road_art(R"(
        A---------B---------C
        |                   |
        D-------------------E
    )",
                              10,
                              {"ABC>", "CE>", "ED>", "DA>"});
    const auto place = [&](double share) {
        return between(art.places.at('A'), art.places.at('B'), share);
    };
    const auto onward = route_between(art.roads, place(0.2), place(0.8));
    EXPECT_NEAR(length_m(onward), 0.6 * distance_m(art.places.at('A'), art.places.at('B')), 0.1);
    const auto round = route_between(art.roads, place(0.8), place(0.2));
    double loop_m = 0;
    for (const auto edge : drivable_edges(art.roads)) {
        loop_m += length_m(art.roads, edge);
    }
    EXPECT_NEAR(length_m(round), loop_m - length_m(onward), 0.1);
}

TEST(RoadRoute, SaysWhereThereIsNoRoadAndWhereNoWay) {
    const auto art = road_art("A---B     C---D", 10, {"AB", "CD"});
    EXPECT_THAT(refusal_of([&] {
                    route_between(art.roads, art.places.at('A'), {10, 10});
                }),
                HasSubstr("no road within 500 m of 10.00000,10.00000"));
    EXPECT_THAT(
        refusal_of([&] { route_between(art.roads, art.places.at('A'), art.places.at('D')); }),
        HasSubstr("no route from "));
}

} // namespace
} // namespace macadam
