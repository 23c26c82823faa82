#include "render/tiles/mvt_tile.hpp"

#include "support/files/vector_tile_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace macadam::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

const ClassTable& fhwa = *class_table("fhwa");
constexpr TileId tile{14, 8900, 5680};
constexpr std::uint32_t unit = 1U << 6U; // of the tile, in world units: 2^(32 - 14 - 12)

WorldPoint at(int x, int y) {
    constexpr std::int64_t side = std::int64_t{4096} * unit;
    return {std::uint32_t(tile.x * side + x * std::int64_t{unit}),
            std::uint32_t(tile.y * side + y * std::int64_t{unit})};
}

TileSegment segment(TileWords& words) {
    TileSegment made{};
    made.state = {.segment = {1234, false, 7},
                  .iri_um = 2134,
                  .sd_um = 210,
                  .low_um = 1789,
                  .high_um = 2480,
                  .left_um = {},
                  .right_um = {},
                  .centre_only = false,
                  .validity = 0,
                  .passes = 5,
                  .vehicles = 2,
                  .first_seen_ms = 1'767'225'600'000, // 2026-01-01T00:00:00Z
                  .last_seen_ms = 1'772'409'599'999,  // 2026-03-01T23:59:59.999Z
                  .trend_um_per_year = 120,
                  .trend_sd_um_per_year = 40,
                  .change = {}};
    made.name = words.number_of("Hafenstraße");
    made.highway = words.number_of("residential");
    made.from_m = 139.96;
    made.to_m = 159.95;
    made.line = {at(100, 200), at(150, 230)};
    return made;
}

ReadTile tile_of(const std::vector<TileSegment>& segments,
                 const TileWords& words,
                 SegmentDetail detail = SegmentDetail::full) {
    std::vector<const TileSegment*> pointers;
    for (const auto& each : segments) {
        pointers.push_back(&each);
    }
    return read_vector_tile(vector_tile(tile, pointers, detail, {&words, &fhwa}));
}

std::vector<std::vector<std::pair<int, int>>> lines_of(const std::vector<WorldPoint>& line) {
    TileWords words;
    auto made = segment(words);
    made.line = line;
    return tile_of({made}, words).features.at(0).lines;
}

bool is_there(const std::vector<WorldPoint>& line) {
    TileWords words;
    auto made = segment(words);
    made.line = line;
    const TileSegment* const pointer = &made;
    return !vector_tile(tile, {&pointer, 1}, SegmentDetail::full, {&words, &fhwa}).empty();
}

// -------------------------------------------------------------------------------------- values

TEST(VectorTile, TellsAllOfASegment) {
    TileWords words;
    const auto read = tile_of({segment(words)}, words);
    EXPECT_EQ(read.layer, "roughness");
    EXPECT_EQ(read.version, 2U);
    EXPECT_EQ(read.extent, 4096U);
    ASSERT_EQ(read.features.size(), 1U);
    const std::map<std::string, TileValue> expected{{"segment", "1234-0007"},
                                                    {"way_id", std::int64_t{1234}},
                                                    {"name", "Hafenstraße"},
                                                    {"highway", "residential"},
                                                    {"direction", "backward"},
                                                    {"from_m", 140.0},
                                                    {"to_m", 160.0},
                                                    {"iri", 2.13},
                                                    {"iri_sd", 0.21},
                                                    {"iri_low", 1.79},
                                                    {"iri_high", 2.48},
                                                    {"class", "fair"},
                                                    {"passes", std::int64_t{5}},
                                                    {"vehicles", std::int64_t{2}},
                                                    {"first_seen", "2026-01-01"},
                                                    {"last_seen", "2026-03-01"},
                                                    {"trend_per_year", 0.12},
                                                    {"validity", "ok"}};
    EXPECT_EQ(read.features[0].values, expected);
}

TEST(VectorTile, LeavesOutWhatIsNotKnown) {
    TileWords words;
    auto made = segment(words);
    made.name = made.highway = 0;
    made.state.first_seen_ms = made.state.last_seen_ms = std::nullopt;
    made.state.trend_um_per_year = std::nullopt;
    const auto values = tile_of({made}, words).features.at(0).values;
    for (const auto* key : {"name", "highway", "first_seen", "last_seen", "trend_per_year"}) {
        EXPECT_FALSE(values.contains(key)) << key;
    }
    EXPECT_EQ(values.size(), 13U);
}

TEST(VectorTile, SaysLessOfASegmentWhereRoomIsShort) {
    TileWords words;
    const auto values = tile_of({segment(words)}, words, SegmentDetail::less).features.at(0).values;
    std::set<std::string> keys;
    for (const auto& [key, value] : values) {
        keys.insert(key);
    }
    EXPECT_THAT(keys,
                UnorderedElementsAre("segment",
                                     "way_id",
                                     "name",
                                     "highway",
                                     "direction",
                                     "from_m",
                                     "to_m",
                                     "iri",
                                     "class",
                                     "passes",
                                     "last_seen",
                                     "validity"));
}

TEST(VectorTile, ListsEveryFieldThatItHas) {
    std::set<std::string> listed;
    for (const auto& field : vector_fields(fhwa)) {
        EXPECT_TRUE(listed.insert(field.name).second) << field.name;
    }
    TileWords words;
    const auto fields = vector_fields(fhwa);
    const auto read = tile_of({segment(words)}, words);
    for (const auto& [key, value] : read.features.at(0).values) {
        const auto found = std::ranges::find(fields, key, &VectorField::name);
        ASSERT_NE(found, fields.end()) << key;
        EXPECT_EQ(found->is_number, !std::holds_alternative<std::string>(value)) << key;
    }
    EXPECT_TRUE(listed.contains("poor_m"));
}

TEST(VectorTile, StoresAValueOnceHoweverManyHaveIt) {
    TileWords words;
    std::vector<TileSegment> segments;
    for (std::uint32_t i = 0; i < 3000; ++i) { // more than the first room for values
        segments.push_back(segment(words));
        segments.back().state.segment.index = i;
        segments.back().state.iri_um = IriUm(500 + 10 * i);
    }
    const auto read = tile_of(segments, words);
    ASSERT_EQ(read.features.size(), 3000U);
    const std::set<TileValue> different{read.values.begin(), read.values.end()};
    EXPECT_EQ(different.size(), read.values.size());
    for (std::uint32_t i = 0; i < 3000; ++i) {
        EXPECT_EQ(read.features[i].values.at("iri"), TileValue{(50.0 + i) / 100});
    }
}

TEST(VectorTile, TellsAPartWithTheLengthOfEachClassInIt) {
    TileWords words;
    RoadPart part{.first = {1234, true, 7},
                  .name = words.number_of("Hafenstraße"),
                  .highway = words.number_of("residential"),
                  .is_directed = true,
                  .validity = 8,
                  .weight_mm = 40'000,
                  .um_mm = 40'000LL * 2500,
                  .worst_um = 4000,
                  .passes = 2,
                  .last_seen_ms = 1'772'409'599'999,
                  .class_mm = {20'000, 0, 20'400},
                  .line = {at(0, 0), at(100, 0)}};
    const auto read_part = [&] {
        const RoadPart* const pointer = &part;
        return read_vector_tile(vector_tile(tile, {&pointer, 1}, {&words, &fhwa})).features.at(0);
    };
    const std::map<std::string, TileValue> expected{{"name", "Hafenstraße"},
                                                    {"highway", "residential"},
                                                    {"iri", 2.5},
                                                    {"iri_worst", 4.0},
                                                    {"class", "fair"},
                                                    {"passes", std::int64_t{2}},
                                                    {"last_seen", "2026-03-01"},
                                                    {"validity", "indicative"},
                                                    {"length_m", std::int64_t{40}},
                                                    {"good_m", std::int64_t{20}},
                                                    {"poor_m", std::int64_t{20}}};
    EXPECT_EQ(read_part().values, expected);
    part.is_directed = false;
    part.class_mm = {0, 40'000, 0};
    EXPECT_FALSE(read_part().values.contains("name"));
    EXPECT_FALSE(read_part().values.contains("fair_m")); // all of it, as class and length say
}

TEST(VectorTile, NumbersASegmentAlikeWhereverItIsDrawn) {
    std::set<std::uint64_t> ids;
    for (const std::int64_t way : {0LL, 1LL, (1LL << 34) - 1}) {
        for (const std::uint32_t index : {0U, 1U, (1U << 18U) - 1}) {
            for (const bool forward : {true, false}) {
                const auto id = feature_id({way, forward, index});
                ASSERT_TRUE(id);
                EXPECT_LT(*id, std::uint64_t{1} << 53U); // what a browser tells apart
                EXPECT_TRUE(ids.insert(*id).second);
            }
        }
    }
    EXPECT_FALSE(feature_id({1LL << 34, true, 0}));
    EXPECT_FALSE(feature_id({-1, true, 0}));
    EXPECT_FALSE(feature_id({1, true, 1U << 18U}));
}

// ------------------------------------------------------------------------------------- geometry

TEST(VectorTile, LaysALineOnItsUnits) {
    EXPECT_THAT(lines_of({at(100, 200), at(150, 230), at(150, 230), at(90, 231)}),
                ElementsAre(ElementsAre(Pair(100, 200), Pair(150, 230), Pair(90, 231))));
}

TEST(VectorTile, CutsALineOffAtItsBuffer) {
    EXPECT_THAT(lines_of({at(-1000, 50), at(5000, 50)}),
                ElementsAre(ElementsAre(Pair(-64, 50), Pair(4160, 50))));
    EXPECT_THAT(lines_of({at(4000, -500), at(4000, 500)}),
                ElementsAre(ElementsAre(Pair(4000, -64), Pair(4000, 500))));
}

TEST(VectorTile, ShowsALineThatLeavesAndComesBackInPieces) {
    EXPECT_THAT(lines_of({at(4000, 100), at(4500, 100), at(4500, 200), at(4000, 200)}),
                ElementsAre(ElementsAre(Pair(4000, 100), Pair(4160, 100)),
                            ElementsAre(Pair(4160, 200), Pair(4000, 200))));
}

TEST(VectorTile, LeavesOutWhatItDoesNotShow) {
    EXPECT_FALSE(is_there({at(-70, 0), at(-65, 4096)}));
    EXPECT_FALSE(is_there({at(-300, 100), at(100, -300)})); // past the corner
    EXPECT_TRUE(is_there({at(-64, 0), at(-64, 10)}));
}

TEST(VectorTile, DrawsALineThatIsSmallerThanAUnitOneUnitLong) {
    auto end = at(7, 9);
    end.x += 3; // of 64
    EXPECT_THAT(lines_of({at(7, 9), end}), ElementsAre(ElementsAre(Pair(7, 9), Pair(8, 9))));
}

/// Whether a place is on a line, give or take a unit and a half of rounding.
bool is_on(std::pair<double, double> place, const std::vector<std::pair<int, int>>& line) {
    for (std::size_t i = 1; i < line.size(); ++i) {
        const double x = line[i - 1].first, y = line[i - 1].second;
        const double dx = line[i].first - x, dy = line[i].second - y;
        const double along = std::clamp(
            ((place.first - x) * dx + (place.second - y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
        if (std::hypot(place.first - x - along * dx, place.second - y - along * dy) < 1.5) {
            return true;
        }
    }
    return false;
}

TEST(VectorTile, CutsLinesAsBruteForceWould) {
    std::mt19937 random{9};
    for (int round = 0; round < 300; ++round) {
        std::vector<WorldPoint> line;
        std::vector<std::pair<int, int>> corners;
        for (int i = 0; i < 4; ++i) {
            corners.emplace_back(int(random() % 8000) - 2000, int(random() % 8000) - 2000);
            line.push_back(at(corners.back().first, corners.back().second));
        }
        const auto lines =
            is_there(line) ? lines_of(line) : std::vector<std::vector<std::pair<int, int>>>{};
        for (int i = 1; i < 4; ++i) {
            for (int step = 0; step <= 100; ++step) {
                const double x =
                    corners[i - 1].first + (corners[i].first - corners[i - 1].first) * step / 100.0;
                const double y = corners[i - 1].second +
                                 (corners[i].second - corners[i - 1].second) * step / 100.0;
                const bool inside = x > -62 && x < 4158 && y > -62 && y < 4158;
                const bool is_drawn = std::ranges::any_of(lines, [&](const auto& piece) {
                    return is_on({x, y}, piece);
                });
                EXPECT_TRUE(!inside || is_drawn) << round << ": " << x << " " << y;
            }
        }
        for (const auto& piece : lines) {
            for (const auto& [x, y] : piece) {
                EXPECT_TRUE(x >= -64 && x <= 4160 && y >= -64 && y <= 4160) << x << " " << y;
            }
        }
    }
}

} // namespace
} // namespace macadam::testing
