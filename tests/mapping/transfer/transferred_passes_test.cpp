#include "estimator/roughness/roughness_mean.hpp"
#include "mapping/network/build_network.hpp"
#include "mapping/transfer/transferred_passes.hpp"

#include "support/roads/edited_network.hpp"
#include "support/roads/road_art.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

/// 1200 m of road with a joint in its middle, both ways.
testing::RoadArt long_street() {
    return testing::road_art("A---------B---------C", 60, {"ABC"});
}

double station_of(const WayMeasureRange& range) {
    return (range.from_m + range.to_m) / 2;
}

/// A reading that tells its station.
IriUm iri_at(double station_m) {
    return static_cast<IriUm>(std::lround(3000 + 1000 * std::sin(station_m / 50)));
}

RoughnessCode cell_at(std::int32_t metre) {
    return static_cast<RoughnessCode>(std::abs(metre * 7) % 200);
}

/// A trip along a way in one direction at 10 m/s.
TripPasses driven(const RoadNetwork& roads,
                  std::int64_t way_id,
                  bool forward,
                  std::uint32_t drive = 0,
                  std::int64_t start_ms = 0) {
    TripPasses trip;
    const auto way = way_at(roads, *way_numbered(roads, way_id));
    const double whole_m = way.along_m.back();
    const double first_station_m = forward ? 0 : -whole_m;
    for (auto i = way.first_link; i < way.past_link; ++i) {
        for (const auto& segment : segments_of(roads, edge_of(LinkId{i}, forward))) {
            const auto range = *stations_of(roads, segment.key);
            const auto um = iri_at(station_of(range));
            trip.passes.push_back(
                {.segment = segment.key,
                 .occurrence = drive,
                 .iri_left_um = um + 10,
                 .iri_right_um = um - 10,
                 .iri_centre_um = std::nullopt,
                 .iri_um = um,
                 .sd_um = um / 10,
                 .centre_only = false,
                 .validity = 0,
                 .speed_mmps = 10'000,
                 .covered_mm = static_cast<std::int32_t>(std::lround(1000 * length_m(range))),
                 .confidence_ppm = 900'000,
                 .t_ms = start_ms + std::lround(100 * (station_of(range) - first_station_m)),
                 .drive = drive});
        }
    }
    std::ranges::sort(trip.passes, {}, [](const Pass& pass) { return pass.t_ms; });
    std::optional<ChunkKey> chunk;
    for (const auto& pass : trip.passes) {
        const auto range = *stations_of(roads, pass.segment);
        if (chunk != chunk_of(pass.segment, 20)) {
            chunk = chunk_of(pass.segment, 20);
            trip.traces.push_back(
                {.chunk = *chunk,
                 .drive = drive,
                 .first_m = static_cast<std::int32_t>(std::floor(range.from_m)) - 10,
                 .iri = {},
                 .left = {},
                 .place_sd_mm = 2500});
        }
        auto& trace = trip.traces.back();
        const auto past = static_cast<std::int32_t>(std::ceil(range.to_m)) + 10;
        for (auto metre = trace.first_m + static_cast<std::int32_t>(trace.iri.size()); metre < past;
             ++metre) {
            trace.iri.push_back(cell_at(metre));
        }
    }
    return trip;
}

struct World {
    RoadNetwork before;
    RoadNetwork after;
    NetworkChange change;

    TransferredPasses carry(const TripPasses& old) const {
        return transfer_passes(old, SegmentCorrespondences{before, after, change});
    }
};

World world(const std::vector<Way>& before, const std::vector<Way>& after) {
    World made{build_network(before), build_network(after), {}};
    made.change = change_between(made.before, made.after);
    return made;
}

std::vector<Pass> sorted(std::vector<Pass> passes) {
    std::ranges::sort(passes, {}, [](const Pass& pass) {
        return std::tuple{pass.segment, pass.occurrence};
    });
    return passes;
}

std::vector<RoughnessTrace> sorted(std::vector<RoughnessTrace> traces) {
    std::ranges::sort(traces, {}, [](const RoughnessTrace& trace) {
        return std::tuple{trace.chunk.way_id, trace.chunk.forward, trace.chunk.number, trace.drive};
    });
    return traces;
}

void expect_same(const Pass& a, const Pass& b) {
    EXPECT_EQ(a.segment, b.segment);
    EXPECT_EQ(a.occurrence, b.occurrence);
    EXPECT_EQ(a.iri_left_um, b.iri_left_um);
    EXPECT_EQ(a.iri_right_um, b.iri_right_um);
    EXPECT_EQ(a.iri_centre_um, b.iri_centre_um);
    EXPECT_EQ(a.iri_um, b.iri_um);
    EXPECT_EQ(a.sd_um, b.sd_um);
    EXPECT_EQ(a.validity, b.validity);
    EXPECT_EQ(a.speed_mmps, b.speed_mmps);
    EXPECT_EQ(a.covered_mm, b.covered_mm);
    EXPECT_EQ(a.confidence_ppm, b.confidence_ppm);
    EXPECT_EQ(a.t_ms, b.t_ms);
    EXPECT_EQ(a.drive, b.drive);
}

void expect_same(const TripPasses& a, const TripPasses& b) {
    const auto first = sorted(a.passes);
    const auto second = sorted(b.passes);
    ASSERT_EQ(first.size(), second.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
        expect_same(first[i], second[i]);
    }
    EXPECT_EQ(sorted(a.traces), sorted(b.traces));
}

TEST(TransferredPasses, OfARenumberedWayAreWhatTheyWere) {
    const auto art = long_street();
    auto edited = testing::edited(art.ways);
    testing::renumber(edited, 1, 50);
    const auto there = world(art.ways, testing::ways_of(edited));
    for (const bool forward : {true, false}) {
        const auto now = there.carry(driven(there.before, 1, forward));
        expect_same(now.readings, driven(there.after, 50, forward));
        EXPECT_EQ(now.lost, 0U);
        EXPECT_EQ(now.moved, now.readings.passes.size());
    }
}

TEST(TransferredPasses, OfAWayThatWasSplitAndMergedAgainAreWhatTheyWere) {
    const auto art = long_street();
    auto edited = testing::edited(art.ways);
    testing::split(edited, 1, 1, 9);
    const auto there = world(art.ways, testing::ways_of(edited));
    const auto back = world(testing::ways_of(edited), art.ways);
    for (const bool forward : {true, false}) {
        const auto first = driven(there.before, 1, forward);
        const auto now = there.carry(first);
        EXPECT_EQ(now.lost, 0U);
        const auto again = back.carry(now.readings);
        EXPECT_EQ(again.lost, 0U);
        // A way drawn anew is cut at its own points; segments differ by centimetres in length, and
        // what they read by what 2 cm of the road are worth.
        const auto expected = sorted(first.passes);
        const auto passes = sorted(again.readings.passes);
        ASSERT_EQ(passes.size(), expected.size());
        for (std::size_t i = 0; i < passes.size(); ++i) {
            EXPECT_EQ(passes[i].segment, expected[i].segment);
            EXPECT_EQ(passes[i].drive, expected[i].drive);
            EXPECT_EQ(passes[i].occurrence, expected[i].occurrence);
            EXPECT_NEAR(passes[i].iri_um, expected[i].iri_um, 2);
            EXPECT_NEAR(passes[i].covered_mm, expected[i].covered_mm, 20);
            EXPECT_NEAR(
                static_cast<double>(passes[i].t_ms), static_cast<double>(expected[i].t_ms), 2);
        }
        EXPECT_EQ(sorted(again.readings.traces), sorted(first.traces));
    }
}

TEST(TransferredPasses, TurnWithAWayThatIsDrawnTheOtherWayRound) {
    const auto art = long_street();
    auto edited = testing::edited(art.ways);
    testing::reverse(edited, 1);
    const auto there = world(art.ways, testing::ways_of(edited));
    const auto whole_m = way_at(there.before, 0).along_m.back();
    const auto old = driven(there.before, 1, true);
    const auto now = there.carry(old);
    EXPECT_EQ(now.lost, 0U);
    ASSERT_THAT(now.readings.passes, SizeIs(old.passes.size()));
    for (const auto& pass : now.readings.passes) {
        EXPECT_FALSE(pass.segment.forward);
        const auto range = *stations_of(there.after, pass.segment);
        EXPECT_NEAR(pass.iri_um, iri_at(station_of(range) + whole_m), 1);
    }
    for (const auto& trace : now.readings.traces) {
        for (std::size_t i = 0; i < trace.iri.size(); ++i) {
            const auto metre = trace.first_m + static_cast<std::int32_t>(i);
            EXPECT_EQ(trace.iri[i],
                      cell_at(metre + static_cast<std::int32_t>(std::lround(whole_m))));
        }
    }
}

/// A side street meets the street 230 m from its beginning.
std::vector<Way> with_new_junction(const std::vector<Way>& ways) {
    auto after = ways;
    const auto junction = between(ways[0].line[0], ways[0].line[1], 230.0 / 600);
    after[0].line.insert(after[0].line.begin() + 1, junction);
    after[0].node_ids.insert(after[0].node_ids.begin() + 1, 500);
    after.push_back({7,
                     "",
                     "",
                     Oneway::no,
                     {500, 501},
                     {junction, {junction.lat_deg + 0.001, junction.lon_deg}}});
    return after;
}

/// Adds an event every 70 m of a trip over way 1.
TripPasses with_events(TripPasses trip, const RoadNetwork& roads) {
    for (const auto& pass : trip.passes) {
        const auto range = *stations_of(roads, pass.segment);
        const double at_m = 70 * std::ceil(range.from_m / 70);
        if (at_m < range.to_m) {
            trip.events.push_back({.segment = pass.segment,
                                   .occurrence = pass.occurrence,
                                   .kind = EventKind::pothole,
                                   .track = WheelTrack::left,
                                   .at_mm = std::llround(1000 * std::abs(at_m)),
                                   .place_sd_mm = 900,
                                   .size_um = 30'000,
                                   .sd_um = 9'000});
        }
    }
    return trip;
}

GeoPoint point_of(const RoadNetwork& roads, const PassEvent& event) {
    const auto link = way_at(roads, *way_numbered(roads, event.segment.way_id)).first_link;
    const auto way = way_at(roads, *way_numbered(roads, event.segment.way_id));
    const double at_m = static_cast<double>(event.at_mm) / 1000;
    for (auto i = link; i < way.past_link; ++i) {
        for (const auto& segment : segments_of(roads, edge_of(LinkId{i}, true))) {
            if (at_m >= segment.from_m && at_m <= segment.to_m) {
                return between(segment.line.front(),
                               segment.line.back(),
                               (at_m - segment.from_m) / (segment.to_m - segment.from_m));
            }
        }
    }
    return {};
}

TEST(TransferredPasses, TakeTheirEventsAlong) {
    const auto art = long_street();
    auto renumbered = testing::edited(art.ways);
    testing::renumber(renumbered, 1, 50);
    auto split = testing::edited(art.ways);
    testing::split(split, 1, 1, 9);
    auto reversed = testing::edited(art.ways);
    testing::reverse(reversed, 1);
    for (const auto& after : {testing::ways_of(renumbered),
                              testing::ways_of(split),
                              testing::ways_of(reversed),
                              with_new_junction(art.ways)}) {
        const auto there = world(art.ways, after);
        for (const bool forward : {true, false}) {
            const auto old = with_events(driven(there.before, 1, forward), there.before);
            ASSERT_GT(old.events.size(), 15U);
            const auto now = there.carry(old).readings;
            ASSERT_EQ(now.events.size(), old.events.size());
            for (const auto& event : now.events) {
                const auto at = point_of(there.after, event);
                const auto same = std::ranges::any_of(old.events, [&](const PassEvent& each) {
                    return distance_m(at, point_of(there.before, each)) < 0.1;
                });
                EXPECT_TRUE(same) << name_of(event.segment);
                EXPECT_TRUE(std::ranges::any_of(now.passes, [&](const Pass& pass) {
                    return pass.segment == event.segment && pass.occurrence == event.occurrence;
                }));
            }
        }
    }
}

/// By brute force: what the old passes say of each centimetre of the new segment.
double
mean_over(const std::vector<Pass>& old, const RoadNetwork& roads, const WayMeasureRange& range) {
    double sum = 0;
    int count = 0;
    for (const auto& pass : old) {
        const auto part = *stations_of(roads, pass.segment);
        if (part.to_m <= range.from_m || part.from_m >= range.to_m) {
            continue;
        }
        for (double at_m = range.from_m + 0.005; at_m < range.to_m; at_m += 0.01) {
            const bool is_there = part.from_m <= at_m && at_m < part.to_m;
            sum += is_there ? pass.iri_um : 0;
            count += is_there ? 1 : 0;
        }
    }
    return sum / count;
}

TEST(TransferredPasses, AreMeansByLengthWhereSegmentsAreCutAnew) {
    const auto art = long_street();
    const auto there = world(art.ways, with_new_junction(art.ways));
    const auto old = driven(there.before, 1, true);
    const auto now = there.carry(old);
    EXPECT_EQ(now.lost, 0U);
    std::size_t checked = 0;
    for (const auto& pass : now.readings.passes) {
        const auto range = *stations_of(there.after, pass.segment);
        EXPECT_NEAR(pass.covered_mm, 1000 * length_m(range), 2); // all of it was driven
        if (range.to_m < 600) {
            // Whole um/m, and borders that are right to a decimetre of some 20 um/m a metre.
            EXPECT_NEAR(pass.iri_um, mean_over(old.passes, there.before, range), 3);
            EXPECT_EQ(pass.iri_left_um, pass.iri_um + 10);
            EXPECT_NEAR(static_cast<double>(pass.t_ms), 100 * station_of(range), 10);
            ++checked;
        }
    }
    EXPECT_GT(checked, 25U);
    std::size_t cells = 0;
    for (const auto& trace : now.readings.traces) {
        for (std::size_t i = 0; i < trace.iri.size(); ++i, ++cells) {
            EXPECT_EQ(trace.iri[i], cell_at(trace.first_m + static_cast<std::int32_t>(i)));
        }
    }
    EXPECT_GT(cells, 1200U);
}

TEST(TransferredPasses, NeedHalfOfASegment) {
    const auto art = long_street();
    const auto there = world(art.ways, with_new_junction(art.ways));
    auto old = driven(there.before, 1, true);
    old.traces.clear();
    // Of segments of 20 m, [220, 240) is now in [209.1, 230) and [230, 250.6): half a segment each.
    old.passes = {old.passes[11]};
    EXPECT_THAT(there.carry(old).readings.passes, IsEmpty());
    EXPECT_EQ(there.carry(old).lost, 1U);
    old.passes[0].segment.index = 10; // [200, 220) is the better half of [209.1, 230)
    EXPECT_THAT(there.carry(old).readings.passes, SizeIs(1));
}

TEST(TransferredPasses, KeepTwoDrivesApart) {
    const auto art = long_street();
    const auto there = world(art.ways, with_new_junction(art.ways));
    auto old = driven(there.before, 1, true, 0, 0);
    const auto later = driven(there.before, 1, true, 1, 500'000);
    for (const auto& pass : later.passes) {
        old.passes.push_back(pass);
        old.passes.back().iri_um += 1000;
    }
    old.traces.insert(old.traces.end(), later.traces.begin(), later.traces.end());
    const auto now = there.carry(old);
    for (const auto& pass : now.readings.passes) {
        const auto range = *stations_of(there.after, pass.segment);
        EXPECT_EQ(pass.drive, pass.occurrence);
        EXPECT_NEAR(pass.iri_um - 1000.0 * pass.occurrence,
                    mean_over(driven(there.before, 1, true).passes, there.before, range),
                    3);
    }
    EXPECT_EQ(now.readings.passes.size() % 2, 0U);
}

TEST(TransferredPasses, OfASurveyWithoutTimesAreMeansToo) {
    const auto art = long_street();
    const auto there = world(art.ways, with_new_junction(art.ways));
    auto old = driven(there.before, 1, true);
    old.traces.clear();
    for (auto& pass : old.passes) {
        pass.t_ms = 0;
        pass.speed_mmps = 0;
        pass.drive = std::nullopt;
    }
    const auto now = there.carry(old);
    EXPECT_EQ(now.lost, 0U);
    const auto way = way_at(there.after, 0);
    const auto last = link_at(there.after, LinkId{way.past_link - 1});
    EXPECT_EQ(now.readings.passes.size(), last.first_segment + last.segments);
    for (const auto& pass : now.readings.passes) {
        const auto range = *stations_of(there.after, pass.segment);
        EXPECT_EQ(pass.occurrence, 0U);
        EXPECT_NEAR(pass.covered_mm, 1000 * length_m(range), 2);
        EXPECT_NEAR(pass.iri_um, mean_over(old.passes, there.before, range), 3);
    }
}

TEST(TransferredPasses, AreLostWithTheirRoad) {
    const auto art = long_street();
    auto edited = testing::edited(art.ways);
    testing::rebuild_aside(edited, 1, 30, 1000);
    const auto there = world(art.ways, testing::ways_of(edited));
    const auto old = driven(there.before, 1, true);
    const auto now = there.carry(old);
    EXPECT_THAT(now.readings.passes, IsEmpty());
    EXPECT_THAT(now.readings.traces, IsEmpty());
    EXPECT_EQ(now.lost, old.passes.size());
}

} // namespace
} // namespace macadam
