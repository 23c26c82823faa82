#include "render/labels/label_placement.hpp"

#include "render/labels/label_lines.hpp"
#include "render/labels/label_painter.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace macadam::testing {
namespace {

constexpr PixelBox cell_box{512, 1024, 1024, 1536};
const LabelCell cell{cell_box, {}};

/// A road through places from the cell's corner.
RoadName road(const std::string& name, const std::vector<PixelPoint>& places, int rank = 3) {
    RoadName made{.line = {}, .name = name, .rank = rank, .half_width_px = 3};
    for (const auto& [x, y] : places) {
        made.line.push_back({cell_box.left + x, cell_box.top + y});
    }
    return made;
}

/// The same in pieces of one step each, as segments come.
std::vector<RoadName> in_pieces(const RoadName& whole) {
    std::vector<RoadName> pieces;
    for (std::size_t i = 0; i + 1 < whole.line.size(); ++i) {
        auto piece = whole;
        piece.line = {whole.line[i], whole.line[i + 1]};
        pieces.push_back(piece);
    }
    return pieces;
}

std::vector<Label> labels_of(const std::vector<RoadName>& roads, const LabelConfig& config = {}) {
    TypeSetter setter;
    return placed_labels(roads, {}, cell, config, setter);
}

/// A town of crooked streets over the cell and what is around it.
std::vector<RoadName> crooked_streets(unsigned seed) {
    std::mt19937 random{seed};
    std::uniform_real_distribution<double> place{-300, 800};
    std::uniform_real_distribution<double> turn{-0.25, 0.25};
    std::uniform_real_distribution<double> any_direction{0, 2 * std::numbers::pi};
    std::vector<RoadName> roads;
    for (int street = 0; street < 60; ++street) {
        std::vector<PixelPoint> places{{place(random), place(random)}};
        double direction = any_direction(random);
        for (int i = 0; i < 60; ++i) {
            direction += turn(random);
            places.push_back({places.back().x + 9 * std::cos(direction),
                              places.back().y + 9 * std::sin(direction)});
        }
        const auto whole = road("Straße " + std::to_string(street / 2), places, street % 6);
        const auto pieces = in_pieces(whole);
        roads.insert(roads.end(), pieces.begin(), pieces.end());
    }
    return roads;
}

void expect_equal(const std::vector<Label>& one, const std::vector<Label>& two) {
    ASSERT_EQ(one.size(), two.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one[i].name, two[i].name);
        ASSERT_EQ(one[i].glyphs.size(), two[i].glyphs.size());
        for (std::size_t g = 0; g < one[i].glyphs.size(); ++g) {
            EXPECT_EQ(one[i].glyphs[g].pose, two[i].glyphs[g].pose); // to the last bit
        }
    }
}

PixelPoint direction_of(const Label& label) {
    const auto& first = label.glyphs.front().pose;
    const auto& last = label.glyphs.back().pose;
    return {last.x_px - first.x_px, last.y_px - first.y_px};
}

Image picture(const std::vector<Label>& labels, const PlanePixel& corner, int side_px) {
    TypeSetter setter;
    Image image{side_px, side_px, std::vector<std::uint8_t>(std::size_t(side_px) * side_px * 3)};
    Canvas canvas{std::move(image)};
    draw_labels(canvas, labels, corner, {0xff0000, 0x00ff00, 0x0000ff}, setter);
    return std::move(canvas).finished();
}

} // namespace

TEST(LabelPlacement, NamesARoadAboveItsLine) {
    const auto labels = labels_of({road("Hauptstraße", {{50, 200}, {450, 200}})});
    ASSERT_EQ(labels.size(), 1U);
    EXPECT_EQ(labels[0].name, "Hauptstraße");
    for (const auto& glyph : labels[0].glyphs) {
        EXPECT_EQ(glyph.pose.along_x, 1);
        EXPECT_LT(glyph.pose.y_px, 200 - 3); // off the road, which is 3 px to either side
        EXPECT_GT(glyph.pose.y_px, 200 - 20);
    }
}

TEST(LabelPlacement, NamesARoadOfManyPiecesInBothDirectionsOnce) {
    std::vector<PixelPoint> places;
    for (int i = 0; i <= 40; ++i) {
        places.push_back({50.0 + 10 * i, 200.0 + i});
    }
    auto pieces = in_pieces(road("Hauptstraße", places));
    const auto forward = pieces;
    for (auto piece : forward) {
        std::ranges::reverse(piece.line);
        pieces.push_back(piece);
    }
    EXPECT_EQ(labels_of(pieces).size(), 1U);
}

TEST(LabelPlacement, IsNeverHeadDown) {
    for (int i = 0; i < 24; ++i) {
        const double angle = i * std::numbers::pi / 12 + 0.01;
        const PixelPoint way{180 * std::cos(angle), 180 * std::sin(angle)};
        const auto labels =
            labels_of({road("Weg", {{256 - way.x, 256 - way.y}, {256 + way.x, 256 + way.y}})});
        ASSERT_EQ(labels.size(), 1U) << i;
        EXPECT_GT(direction_of(labels[0]).x, 0) << i;
    }
}

TEST(LabelPlacement, ReadsStraightRoadsToTheNorthUpwards) {
    for (const bool turned : {false, true}) {
        auto north = road("Nordring", {{256, 100}, {256, 400}});
        if (turned) {
            std::ranges::reverse(north.line);
        }
        const auto labels = labels_of({north});
        ASSERT_EQ(labels.size(), 1U);
        EXPECT_LT(direction_of(labels[0]).y, 0);
    }
}

TEST(LabelPlacement, DependsOnNothingButTheRoadsInTheCell) {
    const auto roads = crooked_streets(7);
    const auto labels = labels_of(roads);
    EXPECT_GT(labels.size(), 8U);

    auto others = roads;
    std::mt19937 random{8};
    std::ranges::shuffle(others, random);
    for (std::size_t i = 0; i < others.size(); i += 2) {
        std::ranges::reverse(others[i].line);
    }
    others.insert(others.end(), roads.begin(), roads.begin() + 300); // some are given twice
    std::erase_if(others, [](const RoadName& piece) {                // those outside are not given
        return std::ranges::all_of(piece.line, [](const PixelPoint& point) {
            return point.x < cell_box.left - 20 || point.x > cell_box.right + 20 ||
                   point.y < cell_box.top - 20 || point.y > cell_box.bottom + 20;
        });
    });
    others.push_back(road("Fern", {{-400, -100}, {900, -90}})); // passes by
    expect_equal(labels_of(others), labels);
}

TEST(LabelPlacement, KeepsLabelsApart) {
    TypeSetter setter;
    for (const unsigned seed : {1U, 2U, 3U}) {
        std::vector<int> inked(512 * 512);
        const auto labels = labels_of(crooked_streets(seed));
        ASSERT_FALSE(labels.empty());
        for (const auto& label : labels) {
            const auto mask = halo_of(label_mask(label, setter), label.halo_px);
            for (int y = 0; y < mask.height; ++y) {
                for (int x = 0; x < mask.width; ++x) {
                    if (mask.coverage[std::size_t(y) * mask.width + std::size_t(x)] > 0) {
                        const int column = mask.left + x - int(cell_box.left);
                        const int row = mask.top + y - int(cell_box.top);
                        ASSERT_TRUE(0 <= column && column < 512 && 0 <= row && row < 512)
                            << label.name << " leaves its cell";
                        EXPECT_EQ(++inked[std::size_t(row) * 512 + std::size_t(column)], 1);
                    }
                }
            }
        }
    }
}

TEST(LabelPlacement, IsTheSamePixelForPixelOnTilesAndOnOnePicture) {
    const auto labels = labels_of(crooked_streets(5));
    const PlanePixel corner{int(cell_box.left), int(cell_box.top)};
    const auto whole = picture(labels, corner, 512);
    for (const auto& [x, y] : {std::pair{0, 0}, {256, 0}, {0, 256}, {256, 256}}) {
        const auto tile = picture(labels, {corner.x + x, corner.y + y}, 256);
        for (int row = 0; row < 256; ++row) {
            const auto* from = whole.rgb.data() + (std::size_t(y + row) * 512 + std::size_t(x)) * 3;
            EXPECT_TRUE(std::equal(from, from + 256 * 3, tile.rgb.data() + std::size_t(row) * 768));
        }
    }
    EXPECT_GT(std::ranges::count_if(whole.rgb, [](auto value) { return value > 0; }), 1000);
}

TEST(LabelPlacement, RepeatsANameAlongALongRoad) {
    TypeSetter setter;
    const LabelCell wide{{0, 0, 4096, 512}, {}};
    const RoadName long_road{
        .line = {{10, 250}, {4080, 260}}, .name = "Bundesstraße", .half_width_px = 3};
    const LabelConfig config{.repeat_px = 400};
    const auto labels = placed_labels(std::vector{long_road}, {}, wide, config, setter);
    ASSERT_EQ(labels.size(), 10U); // 4070 px / 400
    for (std::size_t i = 1; i < labels.size(); ++i) {
        EXPECT_NEAR(labels[i].box.left - labels[i - 1].box.left, 407, 2);
    }
}

TEST(LabelPlacement, NamesTheTwoCarriagewaysOfARoadOnce) {
    EXPECT_EQ(
        labels_of({road("Ring", {{20, 200}, {480, 200}}), road("Ring", {{480, 225}, {20, 225}})})
            .size(),
        1U);
}

TEST(LabelPlacement, LeavesOutWhatDoesNotFitItsRoad) {
    EXPECT_TRUE(labels_of({road("Langenloiser Straße", {{50, 200}, {110, 200}})}).empty());
}

TEST(LabelPlacement, LeavesOutRoadsTooCrookedForLetters) {
    std::vector<PixelPoint> zigzag;
    for (int i = 0; i < 40; ++i) {
        zigzag.push_back({20.0 + 8 * i, i % 2 == 0 ? 200.0 : 215.0});
    }
    EXPECT_TRUE(labels_of({road("Zickzackweg", zigzag)}).empty());
    std::vector<PixelPoint> bow; // of 240 px radius: letters turn by 2 degrees each
    for (int i = 0; i <= 40; ++i) {
        bow.push_back({256 + 240 * std::sin(i * 0.04 - 0.8), 300 - 240 * std::cos(i * 0.04 - 0.8)});
    }
    EXPECT_EQ(labels_of({road("Bogenweg", bow)}).size(), 1U);
}

TEST(LabelPlacement, TurnsNoLetterFurtherThanToldFromTheNext) {
    const LabelConfig config{.max_bend_deg = 10};
    const auto labels = labels_of(crooked_streets(11), config);
    ASSERT_FALSE(labels.empty());
    for (const auto& label : labels) {
        for (std::size_t i = 1; i < label.glyphs.size(); ++i) {
            const auto& a = label.glyphs[i - 1].pose;
            const auto& b = label.glyphs[i].pose;
            EXPECT_GE(a.along_x * b.along_x + a.along_y * b.along_y, std::cos(10.001 / 57.29578));
        }
    }
}

TEST(LabelPlacement, KeepsOffTheLegend) {
    TypeSetter setter;
    const PixelBox legend{cell_box.left + 100, cell_box.top + 150, cell_box.left + 400, 1536};
    const std::vector roads{road("Hauptstraße", {{0, 200}, {512, 200}})};
    const auto labels = placed_labels(roads, {}, {cell_box, {legend}}, {}, setter);
    for (const auto& label : labels) {
        EXPECT_TRUE(label.box.right <= legend.left || legend.right <= label.box.left);
    }
    EXPECT_EQ(placed_labels(roads, {}, cell, {}, setter).size(), 1U);
}

TEST(LabelPlacement, GivesMainRoadsTheirNamesFirst) {
    // The lane has no room above it, so both names want the gap between the two roads.
    const auto labels = labels_of({road("Kirchengasse", {{100, 12}, {205, 12}}, 5),
                                   road("Bundesstraße", {{100, 34}, {205, 34}}, 0)});
    ASSERT_EQ(labels.size(), 1U);
    EXPECT_EQ(labels[0].name, "Bundesstraße");
}

TEST(LabelPlacement, KeepsOffOtherRoads) {
    // A road right above: the name goes below, although above is preferred.
    const auto labels =
        labels_of({road("Ufer", {{50, 200}, {450, 200}}), road("", {{50, 188}, {450, 188}})});
    ASSERT_EQ(labels.size(), 1U);
    EXPECT_GT(labels[0].glyphs[0].pose.y_px, 205);
}

TEST(LabelPlacement, LeavesOutNamesThatNoFontHas) {
    // The last character of Unicode, for private use, which no font on the shelf has.
    EXPECT_TRUE(labels_of({road("\U0010FFFD Zhongshan", {{20, 200}, {480, 200}})}).empty());
}

TEST(LabelPlacement, SetsNamesInChineseCharacters) {
    EXPECT_EQ(labels_of({road("中山路 Zhongshan", {{20, 200}, {480, 200}})}).size(), 1U);
}

TEST(LabelPlacement, SurvivesRoadsThatAreNone) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(labels_of({road("a", {}),
                           road("b", {{5, 5}}),
                           road("c", {{5, 5}, {5, 5}, {5, 5}}),
                           road("d", {{5, 5}, {nan, 300}})})
                    .empty());
}

TEST(LabelPlacement, CellsOfTilesLieOnTheWorldsGrid) {
    EXPECT_EQ(label_cell_at(1023.9, 0).box, (PixelBox{512, 0, 1024, 512}));
    EXPECT_EQ(label_cell_at(1024, 511).box, (PixelBox{1024, 0, 1536, 512}));
}

TEST(LabelPainter, HaloIsEveryPixelWithinReachOfInk) {
    TextMask ink{.left = 3, .top = -2, .width = 4, .height = 3, .coverage = {}};
    ink.coverage = {0, 255, 0, 0, 0, 0, 0, 128, 0, 0, 0, 0};
    const auto halo = halo_of(ink, 2);
    EXPECT_EQ(halo.left, 1);
    EXPECT_EQ(halo.top, -4);
    for (int y = 0; y < halo.height; ++y) {
        for (int x = 0; x < halo.width; ++x) {
            double expected = 0; // by brute force over all inked pixels
            for (int v = 0; v < ink.height; ++v) {
                for (int u = 0; u < ink.width; ++u) {
                    const double apart = std::hypot(x - 2 - u, y - 2 - v);
                    expected = std::max(expected,
                                        ink.coverage[std::size_t(v) * 4 + std::size_t(u)] *
                                            std::clamp(2.5 - apart, 0.0, 1.0));
                }
            }
            EXPECT_NEAR(halo.coverage[std::size_t(y) * std::size_t(halo.width) + std::size_t(x)],
                        expected,
                        1.5); // two roundings to whole levels
        }
    }
}

TEST(LabelPlacement, CentresTheNameOfAPlaceUnlessASymbolIsThere) {
    TypeSetter setter;
    PointName place{.at = {768, 1280}, .name = "Ort", .look = {14, true}};
    const auto alone = placed_labels({}, {&place, 1}, cell, {}, setter);
    ASSERT_EQ(alone.size(), 1U);
    EXPECT_NEAR((alone[0].box.left + alone[0].box.right) / 2, 768, 1);

    place.symbol_px = 3;
    const auto beside = placed_labels({}, {&place, 1}, cell, {}, setter);
    ASSERT_EQ(beside.size(), 1U);
    EXPECT_GT(beside[0].letters[0][0].x, 768 + 3); // to its upper right
    EXPECT_LT(beside[0].letters[0][1].y, 1280 + 3);
}

TEST(LabelPlacement, PutsThePlaceWhereItCoversTheFewestRoads) {
    TypeSetter setter;
    const PointName place{.at = {768, 1280}, .name = "Ort", .look = {14, true}, .symbol_px = 3};
    const auto street = road("", {{260, 250}, {500, 250}}); // to the upper right
    const auto labels = placed_labels({&street, 1}, {&place, 1}, cell, {}, setter);
    ASSERT_EQ(labels.size(), 1U);
    EXPECT_LT(labels[0].box.right, 768 + 5); // the next best, to the left
}

TEST(LabelPlacement, TellsNumbersOfRoadsFromNames) {
    for (const auto* const number : {"A9", "B 191", "E 45", "73", "D6007", "CG-1", "B10a"}) {
        EXPECT_TRUE(is_road_number(number)) << number;
    }
    for (const auto* const name : {"", "Weg 12", "A", "Platz", "12345", "Straße 7", "A 9; A 92"}) {
        EXPECT_FALSE(is_road_number(name)) << name;
    }
}

TEST(LabelPlacement, PutsTheNumberOfARoadUprightOnIt) {
    const auto labels = labels_of({road("B 191", {{50, 60}, {450, 460}})});
    ASSERT_EQ(labels.size(), 1U);
    EXPECT_TRUE(labels[0].is_shield);
    EXPECT_EQ(labels[0].glyphs.front().pose.along_x, 1);
    EXPECT_NEAR((labels[0].box.left + labels[0].box.right) / 2 - cell_box.left,
                (labels[0].box.top + labels[0].box.bottom) / 2 - cell_box.top - 10,
                2); // on the line, which is 10 px lower
}

TEST(LabelPlacement, MovesALabelAsideForOneWithoutRoom) {
    LabelConfig config;
    const auto count = [&](const std::vector<RoadName>& roads) {
        return labels_of(roads, config).size();
    };
    std::size_t before = 0;
    std::size_t after = 0;
    for (unsigned seed = 1; seed <= 6; ++seed) {
        config.moves_others = false;
        before += count(crooked_streets(seed));
        config.moves_others = true;
        after += count(crooked_streets(seed));
    }
    EXPECT_GT(after, before);
}

constexpr PixelPoint middle{512 + 256, 1024 + 256};

/// Places labels in a cell with one place in its middle.
std::vector<Label> around_place(const std::vector<RoadName>& roads, const PointName& place) {
    TypeSetter setter;
    return placed_labels(roads, {&place, 1}, cell, {}, setter);
}

TEST(LabelPlacement, KeepsPlacesOffMeasuredRoadsWhereAPositionIsFree) {
    const PointName town{.at = middle, .name = "Schaan", .look = {14, true}};
    const auto through = road("", {{0, 256}, {512, 256}});
    const auto beside = around_place({through}, town);
    ASSERT_EQ(beside.size(), 1U);
    for (const auto& letter : beside[0].letters) {
        for (const auto& point : letter) {
            EXPECT_GT(std::abs(point.y - middle.y), 2) << "on the road";
        }
    }
    const auto alone = around_place({}, town);
    ASSERT_EQ(alone.size(), 1U);
    EXPECT_NEAR((alone[0].box.left + alone[0].box.right) / 2, middle.x, 3);
}

TEST(LabelPlacement, LeavesVillagesOutWhereMeasuredRoadsAreEverywhere) {
    std::vector<RoadName> roads;
    for (int i = 0; i < 64; ++i) {
        roads.push_back(road("", {{0, 8.0 * i}, {512, 8.0 * i}}));
    }
    PointName place{.at = middle, .name = "Dorf", .look = {14, true}, .may_cover_measured = false};
    EXPECT_TRUE(around_place(roads, place).empty());
}

TEST(LabelPlacement, PutsTheNumberOfARoadInAShieldBesideItsName) {
    auto named = road("Landstraße", {{10, 100}, {500, 100}}, 1);
    named.number = "L 191";
    const auto labels = around_place({named}, {.at = middle, .name = "", .look = {14, true}});
    ASSERT_EQ(labels.size(), 2U);
    const auto shields = std::ranges::count_if(labels, &Label::is_shield);
    EXPECT_EQ(shields, 1);
    EXPECT_EQ(std::ranges::find_if(labels, &Label::is_shield)->name, "L 191");
}

} // namespace macadam::testing
