#include "render/map/map_labels.hpp"

#include "render/labels/label_lines.hpp"
#include "render/map/map_plan.hpp"
#include "render/map/sheet/map_insets.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <utility>

namespace macadam::testing {
namespace {

constexpr double m_per_deg = 111'195;
constexpr double cos_lat = 0.669; // at 48 degrees

GeoPoint at(double east_m, double north_m) {
    return {48 + north_m / m_per_deg, 16 + east_m / m_per_deg / cos_lat};
}

/// A city of 7 by 7 km: crooked streets every 170 m or so both ways, each with a name, in pieces of
/// 170 m, every seventh a main road, and a fifth of the streets without a measurement.
MapScene city() {
    constexpr int streets = 40;
    constexpr double apart_m = 170;
    std::mt19937 random{11};
    std::uniform_real_distribution<double> shift_m{-25, 25};
    std::vector<std::vector<GeoPoint>> corners(streets, std::vector<GeoPoint>(streets));
    for (int row = 0; row < streets; ++row) {
        for (int column = 0; column < streets; ++column) {
            corners[std::size_t(row)][std::size_t(column)] =
                at((column - streets / 2) * apart_m + shift_m(random),
                   (row - streets / 2) * apart_m + shift_m(random));
        }
    }
    MapScene scene;
    scene.box = {.west_deg = at(-3500, 0).lon_deg,
                 .south_deg = at(0, -3500).lat_deg,
                 .east_deg = at(3500, 0).lon_deg,
                 .north_deg = at(0, 3500).lat_deg};
    scene.title = "City";
    for (int street = 0; street < streets; ++street) {
        for (int i = 0; i + 1 < streets; ++i) {
            for (const bool is_row : {true, false}) {
                const auto corner = [&](int along) {
                    return is_row ? corners[std::size_t(street)][std::size_t(along)]
                                  : corners[std::size_t(along)][std::size_t(street)];
                };
                MapLine line;
                line.line = {corner(i), corner(i + 1)};
                line.rank = street % 7 == 0 ? 1 : 4;
                line.iri_class = street % 5 == 1 ? -1 : (street + i) % 3;
                line.name = (is_row ? "Zeile " : "Gasse am ") + std::to_string(street) + ". Platz";
                scene.lines.push_back(line);
            }
        }
    }
    scene.places = {{"Mitte", 1, at(0, 0)}, {"Nordend", 3, at(200, 2600)}};
    return scene;
}

/// Tells whether two convex quadrilaterals overlap: no side separates them.
bool do_overlap(const LabelQuad& a, const LabelQuad& b) {
    const auto is_separated = [](const LabelQuad& one, const LabelQuad& other) {
        for (std::size_t i = 0; i < one.size(); ++i) {
            const auto& from = one[i];
            const auto& to = one[(i + 1) % one.size()];
            const auto side = [&](const PixelPoint& p) {
                return (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
            };
            const double inside = side(one[(i + 2) % one.size()]);
            if (std::ranges::all_of(other, [&](const auto& p) { return side(p) * inside <= 0; })) {
                return true;
            }
        }
        return false;
    };
    return !is_separated(a, b) && !is_separated(b, a);
}

double distance_px(const PixelPoint& p, const LabelQuad& quad) {
    double best = 1e9;
    for (std::size_t i = 0; i < quad.size(); ++i) {
        const auto& a = quad[i];
        const auto& b = quad[(i + 1) % quad.size()];
        const double dx = b.x - a.x;
        const double dy = b.y - a.y;
        const double t = std::clamp(
            ((p.x - a.x) * dx + (p.y - a.y) * dy) / std::max(1e-9, dx * dx + dy * dy), 0.0, 1.0);
        best = std::min(best, std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy));
    }
    return do_overlap(quad, {p, p, p, p}) ? 0 : best;
}

LabelQuad corners_of(const PixelBox& box) {
    return {PixelPoint{box.left, box.top},
            PixelPoint{box.right, box.top},
            PixelPoint{box.right, box.bottom},
            PixelPoint{box.left, box.bottom}};
}

struct City {
    MapScene scene = city();
    PictureSize size{.width_px = 4961, .height_px = 7016, .px_per_inch = 300}; // A2
    TypeSetter setter{};
    Layout layout = layout_of(scene, size, setter);
    Placement placement = placement_of(scene, legend_of(scene, {}, classes_of({})), layout, setter);
    double scale_denominator =
        metres_per_px(placement.frame, 3500) * layout.paper_unit * 96 / 0.0254;
    LineWidths widths = line_widths(metres_per_px(placement.frame, 3500), layout.paper_unit);
    std::vector<Label> labels =
        map_labels(scene, {}, layout, placement, widths, scale_denominator, setter);
};

} // namespace

TEST(MapLabels, OfACityAreManyAndNoneIsOnAnotherACoreOrTheLegend) {
    const City city;
    std::set<std::string> names;
    for (const auto& label : city.labels) {
        names.insert(label.name);
    }
    EXPECT_GE(names.size(), 60U); // of 80 streets and 2 places
    EXPECT_TRUE(names.contains("Mitte"));

    int overlaps = 0;
    for (std::size_t i = 0; i < city.labels.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            const auto hits = [&](const LabelQuad& own) {
                return std::ranges::any_of(city.labels[k].letters, [&](const auto& other) {
                    return do_overlap(own, other);
                });
            };
            overlaps += std::ranges::any_of(city.labels[i].letters, hits) ? 1 : 0;
        }
    }
    EXPECT_EQ(overlaps, 0);

    const auto& corner = city.placement.corner;
    const auto legend = corners_of({corner.x,
                                    corner.y,
                                    corner.x + city.placement.card.width_px,
                                    corner.y + city.placement.card.height_px});
    const auto named = road_names(
        city.scene.lines, city.placement.frame, city.widths, [](const MapLine&) { return true; });
    const auto cores = junction_cores(parts_in(named, city.layout.map));
    ASSERT_GT(cores.size(), 1000U);
    for (const auto& label : city.labels) {
        const bool is_place = label.name == "Mitte" || label.name == "Nordend";
        for (const auto& letter : label.letters) {
            EXPECT_FALSE(do_overlap(letter, legend)) << label.name;
            for (const auto& point : letter) { // whole on the map
                EXPECT_TRUE(city.layout.map.left <= point.x && point.x <= city.layout.map.right &&
                            city.layout.map.top <= point.y && point.y <= city.layout.map.bottom)
                    << label.name;
            }
            for (const auto& [middle, radius_px] : cores) {
                const PixelPoint core{middle.x + city.layout.map.left,
                                      middle.y + city.layout.map.top};
                EXPECT_TRUE(is_place || distance_px(core, letter) > radius_px - 0.01) << label.name;
            }
        }
    }
}

TEST(MapLabels, KeepOffTheLettersOfDetails) {
    const City plain;
    const auto mitte = std::ranges::find(plain.labels, "Mitte", &Label::name);
    ASSERT_NE(mitte, plain.labels.end());
    // Its name is inside the outline, at the corner of the letter.
    const double air = 6 * plain.layout.paper_unit;
    const auto middle = to_pixel(plain.placement.frame, at(0, 0));
    const double m_per_px = metres_per_px(plain.placement.frame, middle.y);
    const double west_m = (mitte->box.left - air - middle.x) * m_per_px;
    const double north_m = (middle.y - mitte->box.top + air) * m_per_px;
    auto scene = city();
    scene.insets.push_back({.box = {.west_deg = at(west_m, 0).lon_deg,
                                    .south_deg = at(0, north_m - 900).lat_deg,
                                    .east_deg = at(west_m + 1200, 0).lon_deg,
                                    .north_deg = at(0, north_m).lat_deg},
                            .name = "Mitte",
                            .scale_denominator = 2500});
    const City city{.scene = std::move(scene)};
    const auto marks = detail_marks(city.scene, city.placement.frame, city.layout);
    const auto tab = corners_of(detail_tab(marks.front(), city.layout));
    const auto is_on_tab = [&](const LabelQuad& letter) { return do_overlap(letter, tab); };
    EXPECT_TRUE(std::ranges::any_of(mitte->letters, is_on_tab)); // without the detail
    for (const auto& label : city.labels) {
        EXPECT_TRUE(std::ranges::none_of(label.letters, is_on_tab)) << label.name;
    }
}

TEST(MapLabels, AreAsTallOnPaperAtAnyResolution) {
    const auto tallest_mm = [](double px_per_inch, int width_px, int height_px) {
        City city{
            .size = {.width_px = width_px, .height_px = height_px, .px_per_inch = px_per_inch}};
        double px = 0;
        for (const auto& label : city.labels) {
            px = std::max(px, label.name.starts_with("Zeile") ? label.look.size_px : 0);
        }
        return px / px_per_inch * 25.4;
    };
    const double at_150 = tallest_mm(150, 2480, 3508);
    EXPECT_NEAR(at_150, 3.1, 0.1); // of a main road
    EXPECT_NEAR(tallest_mm(300, 4961, 7016), at_150, 1e-6);
}

} // namespace macadam::testing
