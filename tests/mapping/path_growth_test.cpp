#include "mapping/match/path_growth.hpp"

#include "support/road_art.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace macadam {
namespace {

using testing::drive;
using testing::edge_between;
using testing::line_through;
using testing::road_art;
using testing::RoadArt;

constexpr RoadSpread spread{.sd_m = 10, .close_sd_m = 3, .oneway_lane_m = 0, .two_way_lane_m = 0};

/// A path over one edge whose ten last (or first) positions alone were matched, grown as far as the
/// positions of the drive lead it.
class PathGrowth : public ::testing::Test {
protected:
    void drive_through(std::string_view letters) {
        trip_ = drive(line_through(art_, letters), {.noise_m = 1});
        auto use = unused(trip_);
        positions_ = positions_of(trip_, make_odometer(trip_, {}, use), no_gyro_, {}, use);
    }

    /// On the edge from 100 m to 130 m after the trip's beginning.
    RoadPath path_on(char from, char to, double begin_m) const {
        const auto edge = edge_between(art_, from, to);
        RoadPath path{{{edge, 0, length_m(art_.roads, edge), 0, 1}}, {}, {}, 0, 1};
        for (std::size_t i = 0; i < positions_.all.size(); ++i) {
            const double on_m = positions_.all[i].travel_m - begin_m;
            if (on_m > 20 && on_m < 80) {
                path.positions.push_back(i);
                path.sample_m.push_back(on_m);
            }
        }
        return path;
    }

    std::string edges_of(const RoadPath& path) const {
        std::string edges;
        for (const auto& leg : path.legs) {
            for (const auto* const word : {"AB", "BC", "CD", "BE", "CF", "FG"}) {
                for (const bool there : {true, false}) {
                    const char a = word[there ? 0 : 1];
                    const char b = word[there ? 1 : 0];
                    if (edge_between(art_, a, b) == leg.edge) {
                        edges += std::string{a, b} + ' ';
                    }
                }
            }
        }
        return edges;
    }

    RoadArt art_ = road_art(R"(
                  E         F---------G
                  |         |
        A---------B---------C---------D
                                     P
                                       Q
    )",
                            10, // 100 m from letter to letter
                            {"AB", "BE", "BC", "CF", "CD", "FG"});
    Heading no_gyro_;
    TripLog trip_;
    Positions positions_{};
};

TEST_F(PathGrowth, LeadsOnOverTheEdgesThatThePositionsDrove) {
    drive_through("ABCD");
    RoadPlane plane{art_.roads, positions_.frame};
    auto path = path_on('A', 'B', 0);
    grow_end(path, art_.roads, plane, positions_, spread, positions_.all.size());
    EXPECT_EQ(edges_of(path), "AB BC CD ");
    EXPECT_NEAR(path.sample_m.back(), 300, 15); // a position each 14 m
    EXPECT_TRUE(std::ranges::is_sorted(path.sample_m));
    EXPECT_LT(path.legs.back().confidence, 0.95); // no sample stands behind it
}

TEST_F(PathGrowth, LeadsBackToWhereTheCarCameOntoTheRoad) {
    drive_through("ABCD");
    RoadPlane plane{art_.roads, positions_.frame};
    auto path = path_on('C', 'D', 200);
    grow_begin(path, art_.roads, plane, positions_, spread, 0);
    EXPECT_EQ(edges_of(path), "AB BC CD ");
    EXPECT_NEAR(path.sample_m.front(), 0, 15);
    EXPECT_TRUE(std::ranges::is_sorted(path.sample_m));
    EXPECT_NEAR(path.legs.back().start_m, 200, 1); // the map's metres are not the drawing's
}

TEST_F(PathGrowth, TurnsWhereThePositionsTurn) {
    drive_through("ABCFG");
    RoadPlane plane{art_.roads, positions_.frame};
    auto path = path_on('A', 'B', 0);
    grow_end(path, art_.roads, plane, positions_, spread, positions_.all.size());
    EXPECT_EQ(edges_of(path), "AB BC CF FG ");
}

TEST_F(PathGrowth, EndsWhereTheCarLeftTheRoad) {
    drive_through("ABCPQ"); // between C and D away to the side
    RoadPlane plane{art_.roads, positions_.frame};
    auto path = path_on('A', 'B', 0);
    grow_end(path, art_.roads, plane, positions_, spread, positions_.all.size());
    EXPECT_TRUE(edges_of(path).starts_with("AB BC "));
    EXPECT_LT(path.sample_m.back(), 250); // 9 m beside CD after 30 m
}

TEST_F(PathGrowth, TakesNoPositionThatBelongsToWhatComesAfter) {
    drive_through("ABCD");
    RoadPlane plane{art_.roads, positions_.frame};
    auto path = path_on('A', 'B', 0);
    const auto limit = path.positions.back() + 4;
    grow_end(path, art_.roads, plane, positions_, spread, limit);
    EXPECT_EQ(path.positions.back(), limit - 1);
    path = path_on('C', 'D', 200);
    const auto first = path.positions.front() - 3;
    grow_begin(path, art_.roads, plane, positions_, spread, first);
    EXPECT_EQ(path.positions.front(), first);
}

} // namespace
} // namespace macadam
