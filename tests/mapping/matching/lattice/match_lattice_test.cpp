#include "mapping/matching/lattice/lattice.hpp"

#include "mapping/matching/lattice/posterior.hpp"
#include "mapping/network/build_network.hpp"
#include "support/roads/match_art.hpp"
#include "support/roads/road_art.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

namespace macadam {
namespace {

using testing::drive;
using ::testing::HasSubstr;
using testing::letters_of;
using testing::line_through;
using testing::match;
using testing::road_art;
using testing::RoadArt;

const MatchedInterval* off_network_of(const MatchedTrace& trace) {
    const auto found = std::find_if(trace.begin(), trace.end(), [](const MatchedInterval& piece) {
        return piece.kind == IntervalKind::off_network;
    });
    return found == trace.end() ? nullptr : &*found;
}

TEST(MatchLattice, LeavesTheNetworkWhereTheMappedRoadEnds) {
    const auto art = road_art(R"(
        A---------B            C---------D
    )",
                              30,
                              {"AB", "CD"});
    const auto line = line_through(art, "ABCD");
    const auto trace = match(drive(line, {.speed_mps = 10}), art);
    const auto* off = off_network_of(trace);
    ASSERT_NE(off, nullptr);
    const double b_m = distance_m(line[0], line[1]);
    EXPECT_NEAR(off->from_travel_m, b_m, 11); // a fix each 10 m
    EXPECT_NEAR(off->to_travel_m, b_m + distance_m(line[1], line[2]), 11);
}

TEST(MatchLattice, GoesRoundNoBlockThatPositionsDidNotGoRound) {
    const auto art = road_art(R"(
        A---------B    C---------D
                  |    |
                  E----F
    )",
                              20,
                              {"AB", "CD", "BEFC"}); // 180 m of road for a gap of 100 m
    EXPECT_EQ(letters_of(match(drive(line_through(art, "ABCD")), art), art), "AB-CD");
    EXPECT_EQ(letters_of(match(drive(line_through(art, "ABEFCD")), art), art), "ABEFCD");
}

TEST(MatchLattice, SaysThatACarParkedOffTheRoad) {
    const auto art = road_art(R"(
        A---------B---------C


                  P
    )",
                              20,
                              {"ABC"});
    auto trip = drive(line_through(art, "ABPBC"));
    const auto b_m = distance_m(art.places.at('A'), art.places.at('B'));
    const auto p_s = (b_m + distance_m(art.places.at('B'), art.places.at('P'))) / 14; // at 14 m/s
    for (auto& fix : trip.fixes) {
        fix.t_s += fix.t_s > p_s ? 600 : 0;
    }
    const auto trace = match(trip, art);
    const auto* off = off_network_of(trace);
    ASSERT_NE(off, nullptr);
    EXPECT_THAT(off->reason, HasSubstr("parked for 60")); // 600 s, and the way of a spacing
}

TEST(MatchLattice, ListsNoRoadThatWasHardlyTouched) {
    const auto art = road_art(R"(
        A---------B---------C
                  |
                  D
    )",
                              20,
                              {"ABC", "BD"});
    auto line = line_through(art, "ABA");
    line[1] = between(art.places.at('B'), art.places.at('C'), 0.02); // 4 m
    EXPECT_EQ(letters_of(match(drive(line, {.speed_mps = 5}), art), art), "ABA");
}

/// Two unseen ways of one length from B to E; the turn from AB into one of them is forbidden.
TEST(MatchLattice, KeepsToTurnsThatAreAllowed) {
    for (const auto& [forbidden, driven] : {std::pair{2, "ABGHEF"}, std::pair{3, "ABCDEF"}}) {
        auto art = road_art(R"(
                      C---------D
            A---------B         E---------F
                      G---------H
        )",
                            20,
                            {"AB", "BCDE", "BGHE", "EF"});
        art.ways[0].turns = {{'B', forbidden}};
        art.roads = build_network(art.ways);
        auto trip = drive(line_through(art, "ABCDEF"));
        std::erase_if(trip.fixes, [](const GnssFix& fix) { return fix.t_s > 13 && fix.t_s < 35; });
        EXPECT_EQ(letters_of(match(trip, art), art), driven);
    }
}

TEST(MatchLattice, BelievesTheGyroAboutATurn) {
    const auto towards = [](double course_rad) {
        return Candidate{false, EdgeId{}, 0, static_cast<float>(course_rad), 0};
    };
    SamplePair between{};
    between.turn = {-std::numbers::pi / 2, 0.01}; // to the right
    const auto north = towards(0);
    const auto east = towards(std::numbers::pi / 2);
    const auto west = towards(3 * std::numbers::pi / 2);
    EXPECT_NEAR(turn_cost(north, east, between), 0, 1e-6);
    EXPECT_GT(turn_cost(north, west, between), turn_cost(north, north, between));
    EXPECT_GT(turn_cost(north, north, between), 2);
    between.turn.sd_rad = std::numeric_limits<double>::infinity(); // not measured
    EXPECT_EQ(turn_cost(north, west, between), 0);
}

/// Costs of chance; every state leads to every state of the next sample.
Lattice random_lattice(std::size_t samples, std::size_t states, std::mt19937_64& random) {
    std::uniform_real_distribution<float> cost{0, 1};
    Lattice lattice;
    lattice.first_state.push_back(0);
    lattice.first_transition.push_back(0);
    for (std::size_t sample = 0; sample < samples; ++sample) {
        const auto first = static_cast<std::uint32_t>(lattice.states.size());
        for (std::uint32_t i = 0; i < states; ++i) {
            lattice.states.push_back({{false, EdgeId{i}, 0, 0, cost(random)}, 0, 0});
            for (std::uint32_t j = 0; sample > 0 && j < states; ++j) {
                const auto from = first - static_cast<std::uint32_t>(states) + j;
                lattice.transitions.push_back({from, first + i, cost(random), true});
            }
        }
        lattice.first_state.push_back(lattice.states.size());
        lattice.first_transition.push_back(lattice.transitions.size());
    }
    return lattice;
}

TEST(MatchLattice, WeighsStatesAsAllChainsThroughThemDo) {
    constexpr std::size_t samples = 4;
    constexpr std::size_t states = 3;
    std::mt19937_64 random{5};
    const auto lattice = random_lattice(samples, states, random);
    std::vector<double> expected(lattice.states.size(), 0.0);
    double whole = 0;
    for (std::size_t chain = 0; chain < 81; ++chain) { // 3^4
        std::vector<std::size_t> at;
        double cost = 0;
        for (std::size_t sample = 0, rest = chain; sample < samples; ++sample, rest /= states) {
            at.push_back(sample * states + rest % states);
            cost += static_cast<double>(lattice.states[at.back()].candidate.cost);
            for (const auto& way : lattice.transitions) {
                if (sample > 0 && way.from == at[sample - 1] && way.to == at[sample]) {
                    cost += static_cast<double>(way.cost);
                }
            }
        }
        const double weight = std::exp(-3 * cost); // as sharp as the posterior is
        whole += weight;
        for (const auto state : at) {
            expected[state] += weight;
        }
    }
    const auto posterior = posteriors(lattice).all;
    ASSERT_EQ(expected.size(), samples * states);
    ASSERT_EQ(posterior.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_NEAR(posterior[i], expected[i] / whole, 1e-6); // costs are floats
    }
}

} // namespace
} // namespace macadam
