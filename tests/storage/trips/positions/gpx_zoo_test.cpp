// Every track of tests/data/gpx, matched with what is known of it.

#include "estimator/motion/make_odometer.hpp"
#include "mapping/matching/arcs.hpp"
#include "mapping/matching/map_match.hpp"
#include "mapping/network/build_network.hpp"
#include "storage/networks/network_reader.hpp"
#include "storage/trips/trip_reader.hpp"

#include "support/files/files.hpp"
#include "support/program/places.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const auto zoo = fs::path{source_folder()} / "tests/data/gpx";

TripLog tour(const std::string& name) {
    return read_trip({.file = zoo / (name + ".gpx"), .member = {}}, needs_of_match());
}

/// The places of a track, each once in a row.
std::vector<GeoPoint> line_of(const TripLog& trip) {
    std::vector<GeoPoint> line;
    for (const auto& fix : trip.fixes) {
        if (line.empty() || !(line.back() == fix.at)) {
            line.push_back(fix.at);
        }
    }
    return line;
}

double length_m(const std::vector<GeoPoint>& line) {
    double sum_m = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        sum_m += distance_m(line[i - 1], line[i]);
    }
    return sum_m;
}

double on_roads_m(const MatchedTrace& trace) {
    double sum_m = 0;
    for (const auto& piece : trace) {
        sum_m += piece.to_offset_m - piece.from_offset_m;
    }
    return sum_m;
}

std::size_t holes_in(const MatchedTrace& trace) {
    return static_cast<std::size_t>(std::count_if(
        trace.begin(), trace.end(), [](const auto& p) { return p.kind != IntervalKind::road; }));
}

MatchedTrace matched(const TripLog& trip, const RoadNetwork& roads) {
    return map_match(trip, make_odometer(trip, {}).odometer, roads, {}).trace;
}

constexpr const char* tours[] = {"another-tour-with-loop",
                                 "gpxv1_0",
                                 "issue-13",
                                 "issue-70",
                                 "test1",
                                 "test2",
                                 "test2_no_millis",
                                 "tour-with-loop",
                                 "tour2-with-loop",
                                 "tour3-with-long-edge",
                                 "tour4-with-uturn"};

/// The streets of all tours, as two-way roads that meet where tours have the same point: most of
/// their points are where a router put them, on the vertices of streets.
struct Streets {
    std::map<std::pair<double, double>, std::int64_t> nodes;
    RoadNetwork roads;

    Streets() {
        std::vector<Way> ways;
        std::set<std::pair<std::int64_t, std::int64_t>> drawn;
        for (const auto* const name : tours) {
            const auto line = line_of(tour(name));
            for (std::size_t i = 1; i < line.size(); ++i) {
                const auto from = node(line[i - 1]);
                const auto to = node(line[i]);
                if (drawn.insert(std::minmax(from, to)).second) {
                    ways.push_back({static_cast<std::int64_t>(ways.size() + 1),
                                    "",
                                    "",
                                    Oneway::no,
                                    {from, to},
                                    {line[i - 1], line[i]}});
                }
            }
        }
        roads = build_network(std::move(ways));
    }

    std::int64_t node(const GeoPoint& at) {
        return nodes.emplace(std::pair{at.lat_deg, at.lon_deg}, nodes.size() + 1).first->second;
    }
};

class GpxTour : public ::testing::TestWithParam<const char*> {};

TEST_P(GpxTour, OnItsOwnStreetsIsDrivenFromPointToPoint) {
    static Streets streets;
    const auto trip = tour(GetParam());
    const auto line = line_of(trip);
    const auto trace = matched(trip, streets.roads);
    EXPECT_EQ(holes_in(trace), 0U);
    // A sample each 40 m leaves a few metres open where a track begins and ends.
    EXPECT_NEAR(on_roads_m(trace), length_m(line), 0.01 * length_m(line) + 10);
    std::vector<std::int64_t> driven;
    for (const auto& arc : arcs_of(trace, streets.roads)) {
        driven.push_back(arc.to_node);
    }
    std::vector<std::int64_t> expected;
    for (std::size_t i = 1; i < line.size(); ++i) {
        expected.push_back(streets.node(line[i]));
    }
    if (distance_m(line[line.size() - 2], line.back()) < 15) { // those few metres, see above
        expected.resize(std::min(expected.size(), driven.size()));
    }
    EXPECT_EQ(driven, expected);
}

INSTANTIATE_TEST_SUITE_P(Zoo, GpxTour, ::testing::ValuesIn(tours), [](const auto& tested) {
    std::string name{tested.param};
    std::replace_if(
        name.begin(), name.end(), [](char c) { return std::isalnum(c) == 0; }, '_');
    return name;
});

TEST(GpxZoo, FollowsTheStreetsOfAndorraWithoutADetour) {
    const auto trip = tour("andorra_for_map_matching");
    const auto roads = build_network(
        read_network(fs::path{source_folder()} / "sample_data/networks/andorra.osm.pbf", {}, {}));
    const auto trace = matched(trip, roads);
    EXPECT_EQ(holes_in(trace), 0U);
    // Drawn by hand along the streets.
    EXPECT_NEAR(on_roads_m(trace), length_m(line_of(trip)), 0.03 * length_m(line_of(trip)));
    for (const auto& piece : trace) {
        EXPECT_GT(piece.confidence, 0.5);
    }
}

TEST(GpxZoo, RefusesFilesWithoutATrack) {
    for (const auto* const name : {"no_trk", "no_trkseg", "no_trkpt", "test-only-wpt"}) {
        EXPECT_THAT(refusal_of([&] { tour(name); }),
                    HasSubstr("expected a track (trk) with points (trkpt)"))
            << name;
    }
}

TEST(GpxZoo, RefusesATrackThatNeverMoves) {
    const auto trip = tour("issue-127"); // one place, twice
    EXPECT_THAT(refusal_of([&] { matched(trip, build_network({})); }),
                HasSubstr("expected speeds or at least 2 fixes"));
}

TEST(GpxZoo, HasNoOtherFiles) {
    std::set<std::string> known{std::begin(tours), std::end(tours)};
    known.insert({"andorra_for_map_matching",
                  "issue-127",
                  "no_trk",
                  "no_trkpt",
                  "no_trkseg",
                  "test-only-wpt"});
    ASSERT_FALSE(fs::is_empty(zoo));
    for (const auto& entry : fs::directory_iterator{zoo}) {
        if (entry.path().extension() == ".gpx") {
            EXPECT_EQ(known.count(entry.path().stem().string()), 1U) << entry.path();
        }
    }
}

} // namespace
} // namespace macadam::testing
