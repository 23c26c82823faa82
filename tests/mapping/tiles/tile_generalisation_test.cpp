#include "mapping/tiles/tile_generalisation.hpp"

#include "mapping/tiles/line_merging.hpp"
#include "mapping/tiles/line_simplification.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <set>

namespace macadam {
namespace {

using ::testing::ElementsAre;

const ClassTable& fhwa = *class_table("fhwa"); // good < 1.499, fair <= 2.683, poor

constexpr IriUm good_um = 1000, fair_um = 2000, poor_um = 4000;
constexpr std::uint32_t start = 1U << 31U;    // the middle of the world
constexpr std::uint32_t segment_units = 2200; // 20 m at the equator

/// A segment of a straight road eastwards.
TileSegment segment(std::int64_t way, std::uint32_t index, bool forward, IriUm iri_um) {
    const WorldPoint from{start + index * segment_units, start}, to{from.x + segment_units, start};
    TileSegment made{};
    made.state.segment = {way, forward, index};
    made.state.iri_um = iri_um;
    made.state.passes = 3;
    made.from_m = 20.0 * index;
    made.to_m = made.from_m + 20;
    made.line = forward ? std::vector{from, to} : std::vector{to, from};
    return made;
}

std::vector<TileSegment> road(const std::vector<IriUm>& iri_um, bool forward = true) {
    std::vector<TileSegment> segments;
    for (std::uint32_t i = 0; i < iri_um.size(); ++i) {
        segments.push_back(segment(1, i, forward, iri_um[i]));
    }
    return segments;
}

std::vector<std::int64_t> class_mm_of(const std::vector<RoadPart>& parts) {
    std::vector<std::int64_t> sums(fhwa.classes.size(), 0);
    for (const auto& part : parts) {
        std::ranges::transform(part.class_mm, sums, sums.begin(), std::plus<>{});
    }
    return sums;
}

// ----------------------------------------------------------------------------------------- runs

TEST(TileGeneralisation, JoinsNeighboursOfOneClass) {
    const auto parts = generalised(parts_of(road({good_um, 1200, fair_um, poor_um, poor_um}), fhwa),
                                   generalisation_at(13),
                                   fhwa);
    ASSERT_EQ(parts.size(), 3U);
    EXPECT_EQ(length_mm(parts[0]), 40'000);
    EXPECT_DOUBLE_EQ(iri_of(parts[0]), 1.1); // of two of the same length
    EXPECT_EQ(parts[0].worst_um, 1200);
    EXPECT_EQ(length_mm(parts[1]), 20'000);
    EXPECT_EQ(length_mm(parts[2]), 40'000);
    EXPECT_THAT(parts[2].line,
                ElementsAre(WorldPoint{start + 3 * segment_units, start},
                            WorldPoint{start + 5 * segment_units, start}));
}

TEST(TileGeneralisation, WeightsTheMeanByLength) {
    auto segments = road({1000, 1300});
    segments[1].to_m = segments[1].from_m + 60;
    const auto parts = generalised(parts_of(segments, fhwa), generalisation_at(13), fhwa);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_DOUBLE_EQ(iri_of(parts[0]), (1.0 * 20 + 1.3 * 60) / 80);
}

TEST(TileGeneralisation, TellsTheFewestPassesTheLatestDayAndWhatHoldsForAll) {
    auto segments = road({good_um, good_um});
    segments[0].state.passes = 7;
    segments[1].state.passes = 2;
    segments[0].state.last_seen_ms = 5000;
    const auto parts = generalised(parts_of(segments, fhwa), generalisation_at(13), fhwa);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_EQ(parts[0].passes, 2);
    EXPECT_EQ(parts[0].last_seen_ms, 5000);
}

TEST(TileGeneralisation, KeepsApartWhatIsNotAsValid) {
    auto segments = road({good_um, good_um});
    segments[1].state.validity = 8;
    EXPECT_EQ(generalised(parts_of(segments, fhwa), generalisation_at(13), fhwa).size(), 2U);
}

TEST(TileGeneralisation, KeepsApartRoadsOfOtherNamesAndClasses) {
    auto segments = road({good_um, good_um});
    segments[1].name = 1;
    EXPECT_EQ(generalised(parts_of(segments, fhwa), generalisation_at(13), fhwa).size(), 2U);
    segments[1].name = 0;
    segments[1].highway = 1;
    EXPECT_EQ(generalised(parts_of(segments, fhwa), generalisation_at(13), fhwa).size(), 2U);
    segments[0].name = segments[1].name = 1; // one name: one road
    EXPECT_EQ(generalised(parts_of(segments, fhwa), generalisation_at(13), fhwa).size(), 1U);
}

TEST(TileGeneralisation, GivesAShortRunToTheNeighbourThatIsNearestInIri) {
    std::vector<IriUm> iri(60, good_um);
    iri[30] = fair_um;
    std::fill(iri.begin() + 31, iri.end(), poor_um);
    const auto parts = generalised(parts_of(road(iri), fhwa), generalisation_at(11), fhwa);
    ASSERT_EQ(parts.size(), 2U); // two pixels of zoom 11 are 153 m at the equator
    EXPECT_THAT(parts[0].class_mm, ElementsAre(600'000, 20'000, 0));
    EXPECT_THAT(parts[1].class_mm, ElementsAre(0, 0, 580'000));
    EXPECT_EQ(class_of(parts[0], fhwa), 0U);
}

// ---------------------------------------------------------------------------------- directions

TEST(TileGeneralisation, ShowsTheRougherOfBothDirectionsAndCountsBoth) {
    auto segments = road({good_um});
    const auto back = road({poor_um}, false);
    segments.push_back(back[0]);
    const auto parts = parts_of_both_ways(segments, fhwa);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_FALSE(parts[0].is_directed);
    EXPECT_DOUBLE_EQ(iri_of(parts[0]), 4.0);
    EXPECT_THAT(parts[0].class_mm, ElementsAre(20'000, 0, 20'000));
    EXPECT_EQ(parts[0].line, segments[0].line); // along the way
    EXPECT_EQ(parts[0].first, segments[0].state.segment);
}

TEST(TileGeneralisation, LaysARoadThatWasDrivenBackwardAloneAlongItsWay) {
    const auto parts = parts_of_both_ways(road({good_um}, false), fhwa);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_FALSE(parts[0].is_directed);
    EXPECT_THAT(parts[0].line,
                ElementsAre(WorldPoint{start, start}, WorldPoint{start + segment_units, start}));
}

TEST(TileGeneralisation, DoesNotJoinADirectionWithTheOther) {
    auto segments = road({good_um, good_um});
    for (const auto& back : road({good_um, good_um}, false)) {
        segments.push_back(back);
    }
    const auto parts = generalised(parts_of(segments, fhwa), generalisation_at(13), fhwa);
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_EQ(parts[0].line.front(), parts[1].line.back());
    EXPECT_EQ(parts[1].line.front(), parts[0].line.back());
}

// --------------------------------------------------------------------------------------- chains

RoadPart part(std::uint32_t index, std::vector<WorldPoint> line, bool is_directed = false) {
    RoadPart made{};
    made.first = {1, true, index};
    made.is_directed = is_directed;
    made.class_mm = {20'000, 0, 0};
    made.weight_mm = 20'000;
    made.line = std::move(line);
    return made;
}

TEST(PartChains, GoStraightOnWhereRoadsMeet) {
    const WorldPoint middle{1000, 1000};
    const std::vector parts{part(0, {{0, 1000}, middle}),
                            part(1, {middle, {2000, 1100}}),
                            part(2, {middle, {1800, 1800}})};
    const auto chains = part_chains(parts);
    ASSERT_EQ(chains.size(), 2U);
    ASSERT_EQ(chains[0].size(), 2U);
    EXPECT_EQ(chains[0][1].part, 1U);
    EXPECT_EQ(chains[1][0].part, 2U);
}

TEST(PartChains, DoNotTurnSharply) {
    const std::vector parts{part(0, {{0, 0}, {1000, 0}}), part(1, {{1000, 0}, {1400, 900}})};
    EXPECT_EQ(part_chains(parts).size(), 2U); // 66 degrees
}

TEST(PartChains, TakePartsOfBothDirectionsFromEitherEnd) {
    const std::vector parts{part(0, {{0, 0}, {1000, 0}}), part(1, {{2000, 0}, {1000, 0}})};
    const auto chains = part_chains(parts);
    ASSERT_EQ(chains.size(), 1U);
    EXPECT_FALSE(chains[0][0].reversed);
    EXPECT_TRUE(chains[0][1].reversed);
}

TEST(PartChains, JoinDirectedPartsEndToBeginningAlone) {
    const std::vector parts{part(0, {{0, 0}, {1000, 0}}, true),
                            part(1, {{2000, 0}, {1000, 0}}, true)};
    EXPECT_EQ(part_chains(parts).size(), 2U);
}

TEST(PartChains, CutARingOpenAtItsFirstPart) {
    std::vector<RoadPart> parts;
    constexpr std::uint32_t count = 12;
    const auto corner = [](std::uint32_t i) {
        const double angle = 2 * std::numbers::pi * (i % count) / count;
        return WorldPoint{std::uint32_t(5000 + std::lround(4000 * std::cos(angle))),
                          std::uint32_t(5000 + std::lround(4000 * std::sin(angle)))};
    };
    for (std::uint32_t i = 0; i < count; ++i) {
        parts.push_back(part(i, {corner(i), corner(i + 1)}, true));
    }
    const auto chains = part_chains(parts);
    ASSERT_EQ(chains.size(), 1U);
    EXPECT_EQ(chains[0].size(), count);
    EXPECT_EQ(chains[0][0].part, 0U);
}

// ---------------------------------------------------------------------------------------- cells

TEST(TileGeneralisation, DrawsTheLongestOfRoadsTooSmallToTellApart) {
    const auto how = generalisation_at(8); // whose pixel is 65536 units
    std::vector<RoadPart> parts;
    for (std::uint32_t i = 0; i < 5; ++i) { // side by side, far from meeting
        parts.push_back(part(i, {{start, start + 100 * i}, {start + 1000 + i, start + 100 * i}}));
    }
    parts[2].um_mm = parts[2].weight_mm * poor_um;
    const auto drawn = generalised(parts, how, fhwa);
    ASSERT_EQ(drawn.size(), 1U);
    EXPECT_EQ(length_mm(drawn[0]), 100'000);
    EXPECT_EQ(drawn[0].first, parts[0].first);
    EXPECT_EQ(drawn[0].line, parts[4].line);
    EXPECT_DOUBLE_EQ(iri_of(drawn[0]), 0.8); // 4.0 of a fifth
}

// ------------------------------------------------------------------------------------ accounting

/// Streets at random, some of which meet.
std::vector<RoadPart> town(std::mt19937& random, std::size_t streets) {
    std::vector<RoadPart> parts;
    for (std::uint32_t street = 0; street < streets; ++street) {
        double x = start + double(random() % 500'000), y = start + double(random() % 500'000);
        double angle = double(random() % 628) / 100;
        const auto segments = 1 + random() % 40;
        for (std::uint32_t i = 0; i < segments; ++i) {
            const WorldPoint from{std::uint32_t(x), std::uint32_t(y)};
            x += segment_units * std::cos(angle);
            y += segment_units * std::sin(angle);
            angle += double(random() % 100) / 100 - 0.5;
            auto made = part(i, {from, {std::uint32_t(x), std::uint32_t(y)}});
            const auto iri_um = IriUm(500 + random() % 4000);
            const auto mm = 18'000 + std::int64_t(random() % 4000);
            made.first.way_id = street;
            made.name = street % 50;
            made.weight_mm = mm;
            made.um_mm = mm * iri_um;
            made.class_mm = {0, 0, 0};
            made.class_mm[class_index(fhwa, iri_um / 1000.0)] = mm;
            parts.push_back(std::move(made));
        }
    }
    return parts;
}

TEST(TileGeneralisation, LosesNoMillimetreOfAnyClassAtAnyZoomOrStep) {
    std::mt19937 random{17};
    const auto parts = town(random, 120);
    const auto whole = class_mm_of(parts);
    for (int zoom = 0; zoom <= 13; ++zoom) {
        for (const int step : {0, 1, 4, 16}) {
            const auto drawn = generalised(parts, generalisation_at(zoom, step), fhwa);
            EXPECT_EQ(class_mm_of(drawn), whole) << zoom << " " << step;
        }
    }
}

TEST(TileGeneralisation, ComesToOnePartWhenItIsCoarsenedFarEnough) {
    std::mt19937 random{17};
    EXPECT_LE(generalised(town(random, 120), generalisation_at(13, 16), fhwa).size(), 4U);
}

TEST(TileGeneralisation, DoesNotDependOnTheOrderOfParts) {
    std::mt19937 random{17};
    auto parts = town(random, 200);
    const auto drawn = generalised(parts, generalisation_at(11), fhwa);
    std::ranges::shuffle(parts, random);
    const auto again = generalised(parts, generalisation_at(11), fhwa);
    ASSERT_EQ(again.size(), drawn.size());
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        EXPECT_EQ(again[i].first, drawn[i].first);
        EXPECT_EQ(again[i].line, drawn[i].line);
        EXPECT_EQ(again[i].um_mm, drawn[i].um_mm);
    }
}

// --------------------------------------------------------------------------------- simplifying

double distance_to_line(const WorldPoint& at, const std::vector<WorldPoint>& line) {
    double nearest = 1e300;
    for (std::size_t i = 1; i < line.size(); ++i) {
        constexpr int steps = 200; // brute force along each piece
        for (int j = 0; j <= steps; ++j) {
            const double share = double(j) / steps;
            const double x = line[i - 1].x + share * (double(line[i].x) - line[i - 1].x) - at.x;
            const double y = line[i - 1].y + share * (double(line[i].y) - line[i - 1].y) - at.y;
            nearest = std::min(nearest, std::hypot(x, y));
        }
    }
    return nearest;
}

TEST(LineSimplification, StaysWithinItsTolerance) {
    std::mt19937 random{3};
    std::vector<WorldPoint> line;
    for (std::uint32_t i = 0; i < 100; ++i) {
        line.push_back({10'000 + 100 * i, 10'000 + std::uint32_t(random() % 120)});
    }
    const auto fewer = simplified(line, 40, [](const WorldPoint&) { return false; });
    EXPECT_LT(fewer.size(), line.size());
    EXPECT_EQ(fewer.front(), line.front());
    EXPECT_EQ(fewer.back(), line.back());
    for (const auto& point : line) {
        EXPECT_LE(distance_to_line(point, fewer), 40 + 0.6); // the brute force is that coarse
    }
}

TEST(LineSimplification, KeepsThePlacesWhereOthersEnd) {
    const std::vector<WorldPoint> line{{0, 0}, {10, 0}, {20, 0}, {30, 0}};
    EXPECT_THAT(simplified(line, 5, [](const WorldPoint& p) { return p.x == 20; }),
                ElementsAre(WorldPoint{0, 0}, WorldPoint{20, 0}, WorldPoint{30, 0}));
}

} // namespace
} // namespace macadam
