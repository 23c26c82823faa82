#include "mapping/background/background_tiling.hpp"

#include "mapping/background/background_levels.hpp"
#include "mapping/background/background_pieces.hpp"

#include "estimator/common/error.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace macadam {
namespace {

using ::testing::ElementsAre;
using ::testing::Gt;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr GeoBox box{.west_deg = 9.4, .south_deg = 47.0, .east_deg = 9.7, .north_deg = 47.3};

PackedPoint at(double lat_deg, double lon_deg) {
    return packed({lat_deg, lon_deg});
}

using Tiles = std::map<TileId, std::vector<BackgroundPiece>>;

Tiles tiled(const BackgroundFeature& feature) {
    Tiles tiles;
    BackgroundTiling tiling{[&](const TileId& tile, std::string_view pieces) {
        visit_pieces(pieces, [&](const BackgroundPiece& piece) { tiles[tile].push_back(piece); });
    }};
    tiling.add(feature, box);
    tiling.finish();
    return tiles;
}

double area_of(const std::vector<CellPoint>& ring) {
    double twice = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const auto& a = ring[i];
        const auto& b = ring[(i + 1) % ring.size()];
        twice += double(a.x) * b.y - double(b.x) * a.y;
    }
    return twice / 2;
}

double area_at(const Tiles& tiles, int zoom) {
    double sum = 0;
    for (const auto& [tile, pieces] : tiles) {
        for (const auto& piece : pieces) {
            for (const auto& ring : piece.paths) {
                sum += tile.zoom == zoom ? area_of(ring) : 0;
            }
        }
    }
    return sum;
}

/// Circle of a radius in degrees of latitude around the middle of the box, some tiles wide.
std::vector<PackedPoint> circle(double radius_deg, bool is_clockwise) {
    constexpr int corners = 720;
    std::vector<PackedPoint> ring;
    for (int i = 0; i < corners; ++i) {
        const double turn = (is_clockwise ? 1 : -1) * 2 * std::numbers::pi * i / corners;
        ring.push_back(at(47.15 + radius_deg * std::cos(turn), 9.55 + radius_deg * std::sin(turn)));
    }
    return ring;
}

TEST(BackgroundTiling, KeepsTheAreaOfALakeWithAnIslandAtEveryLevelWhateverTheDirectionOfItsRings) {
    const auto lake = tiled({BackgroundKind::water, {circle(0.05, true), circle(0.02, true)}});
    const auto turned = tiled({BackgroundKind::water, {circle(0.05, false), circle(0.02, false)}});
    EXPECT_THAT(lake, SizeIs(Gt(20U))); // else nothing was cut
    for (const auto& level : background_levels) {
        const double cells_per_deg = std::ldexp(background_cells, level.zoom) / 360;
        const double stretch = 1 / std::cos(47.15 * std::numbers::pi / 180); // Mercator's
        const double expected = std::numbers::pi * (0.05 * 0.05 - 0.02 * 0.02) * cells_per_deg *
                                cells_per_deg * stretch;
        const double outline = 2 * std::numbers::pi * 0.07 * cells_per_deg * stretch;
        const double tolerance = outline * level.tolerance;
        EXPECT_NEAR(area_at(lake, level.zoom), expected, tolerance) << level.zoom;
        EXPECT_NEAR(area_at(turned, level.zoom), expected, tolerance) << level.zoom;
    }
}

TEST(BackgroundTiling, LeavesNoTraceInTilesWithinAHole) {
    const auto lake = tiled({BackgroundKind::water, {circle(0.1, true), circle(0.09, true)}});
    const auto middle = tile_position({47.15, 9.55}, 14);
    EXPECT_FALSE(lake.contains({14, std::uint32_t(middle.x), std::uint32_t(middle.y)}));
    EXPECT_THAT(lake, SizeIs(Gt(20U)));
}

TEST(BackgroundTiling, CutsALineIntoPartsThatMeetOnTheSidesOfTiles) {
    const auto line = tiled({BackgroundKind::river, {{at(47.05, 9.45), at(47.2, 9.65)}}});
    double length = 0;
    std::size_t parts = 0;
    for (const auto& [tile, pieces] : line) {
        for (const auto& piece : pieces) {
            for (const auto& path : piece.paths) {
                for (std::size_t i = 1; tile.zoom == 14 && i < path.size(); ++i, ++parts) {
                    length += std::hypot(path[i].x - path[i - 1].x, path[i].y - path[i - 1].y);
                }
            }
        }
    }
    const auto from = tile_position({47.05, 9.45}, 14);
    const auto to = tile_position({47.2, 9.65}, 14);
    const double expected = background_cells * std::hypot(to.x - from.x, to.y - from.y);
    EXPECT_NEAR(length, expected, double(parts)); // each end is rounded to half a cell
    EXPECT_GT(parts, 10U);
}

TEST(BackgroundTiling, KeepsBuildingsForLargeScalesAlone) {
    const auto house = tiled(
        {BackgroundKind::building, {{at(47.105, 9.51), at(47.105, 9.5103), at(47.1052, 9.5103)}}});
    ASSERT_THAT(house, SizeIs(1));
    EXPECT_EQ(house.begin()->first.zoom, 14);
    EXPECT_EQ(house.begin()->second.at(0).kind, BackgroundKind::building);
}

TEST(BackgroundTiling, LeavesOutWhatLiesOutsideTheBoxOrCoversNothing) {
    EXPECT_THAT(tiled({BackgroundKind::forest, {{at(10, 9), at(10, 10), at(11, 10)}}}), IsEmpty());
    EXPECT_THAT(tiled({BackgroundKind::forest, {{at(47.1, 9.5), at(47.1, 9.5), at(47.1, 9.5)}}}),
                IsEmpty());
    EXPECT_THAT(tiled({BackgroundKind::river, {{at(47.1, 9.5)}}}), IsEmpty());
}

TEST(BackgroundTiling, BoundsThePiecesOfAreasOfContinentalSize) {
    constexpr GeoBox globe{.west_deg = -180, .south_deg = -85, .east_deg = 180, .north_deg = 85};
    std::size_t bytes = 0;
    BackgroundTiling tiling{
        [&](const TileId&, std::string_view pieces) { bytes += pieces.size(); }};
    tiling.add({BackgroundKind::forest, {{at(-84, -179), at(-84, 179), at(84, 179), at(84, -179)}}},
               globe);
    tiling.finish();
    EXPECT_GT(bytes, 0U);
    EXPECT_LT(bytes, 32'000'000U); // zoom 14 alone would have 268 million tiles
}

TEST(BackgroundPieces, ComeBackAsTheyWerePacked) {
    std::string bytes;
    const BackgroundPiece lake{BackgroundKind::water,
                               {{{0, 0}, {8192, 0}, {8192, 8192}}, {{5, 5}, {5, 6}, {6, 6}}}};
    const BackgroundPiece rail{BackgroundKind::railway, {{{1, 8192}, {0, 0}}}};
    append_piece(bytes, lake);
    append_piece(bytes, rail);
    std::vector<BackgroundPiece> found;
    visit_pieces(bytes, [&](const BackgroundPiece& piece) { found.push_back(piece); });
    ASSERT_THAT(found, SizeIs(2));
    EXPECT_EQ(found[0].kind, lake.kind);
    EXPECT_EQ(found[0].paths, lake.paths);
    EXPECT_EQ(found[1].kind, rail.kind);
    EXPECT_EQ(found[1].paths, rail.paths);
}

TEST(BackgroundPieces, OfAModifiedDatabaseAreRefusedOrLieWithinTheirTile) {
    std::string bytes;
    append_piece(bytes, {BackgroundKind::forest, {{{10, 10}, {8000, 10}, {8000, 8000}}}});
    std::mt19937 random{23};
    std::size_t refused = 0;
    for (int i = 0; i < 2000; ++i) {
        auto spoilt = bytes.substr(0, 1 + random() % bytes.size());
        spoilt[random() % spoilt.size()] = static_cast<char>(random());
        try {
            visit_pieces(spoilt, [&](const BackgroundPiece& piece) {
                for (const auto& path : piece.paths) {
                    for (const auto& point : path) {
                        EXPECT_TRUE(point.x >= 0 && point.x <= background_cells);
                        EXPECT_TRUE(point.y >= 0 && point.y <= background_cells);
                    }
                }
            });
        } catch (const InputError&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 1000U); // most are cut off
}

} // namespace
} // namespace macadam
