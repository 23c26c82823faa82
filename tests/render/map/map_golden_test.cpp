#include "golden.hpp"
#include "render/map/map_plan.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H
#include <gtest/gtest.h>
#include <hb.h>

#include <array>
#include <cmath>
#include <string>

namespace macadam::testing {
namespace {

constexpr const char* golden_text = "FreeType 2.12.1, HarfBuzz 6.0.0"; // Debian 12's
constexpr double other_mean_levels = 1; // other versions may set letters otherwise

/// A point of the made-up town, in metres east and north of its middle.
GeoPoint at(double east_m, double north_m) {
    constexpr double m_per_deg = 111'195;
    constexpr GeoPoint middle{59.33, 18.05};
    return {middle.lat_deg + north_m / m_per_deg,
            middle.lon_deg + east_m / m_per_deg / std::cos(middle.lat_deg * 0.0174532925)};
}

/// What the pieces of a street are like.
struct Street {
    std::string name;
    int rank = 4;
    int first_class = 0; ///< pieces go up and down from it; -1: not measured
    bool both_ways = true;
    bool certain = true;
    bool few_passes = false;
};

/// A street along a curve of points at even distance, with a class for each piece.
void add(MapScene& scene, const Street& street, const std::vector<GeoPoint>& points) {
    constexpr std::array steps{0, 0, 1, 0, 0, 1, 2, 1, 1, 0};
    for (const bool forward : {true, false}) {
        for (std::size_t i = 0; i + 1 < points.size() && (forward || street.both_ways); ++i) {
            MapLine line;
            line.line = {points[i], points[i + 1]};
            if (!forward) {
                std::swap(line.line.front(), line.line.back());
            }
            const int step = steps.at((i + (forward ? 0 : 3)) % steps.size());
            line.iri_class = street.first_class < 0 ? -1 : std::min(2, street.first_class + step);
            line.both_ways = street.both_ways;
            line.forward = forward;
            line.rank = street.rank;
            line.certain = street.certain || step != 1;
            line.few_passes = street.few_passes && i < points.size() / 3;
            line.name = street.name;
            scene.lines.push_back(line);
        }
    }
}

std::vector<GeoPoint> straight(double from_x, double from_y, double to_x, double to_y) {
    const int pieces = std::max(1, int(std::hypot(to_x - from_x, to_y - from_y) / 22));
    std::vector<GeoPoint> points;
    for (int i = 0; i <= pieces; ++i) {
        const double t = double(i) / pieces;
        points.push_back(at(std::lerp(from_x, to_x, t), std::lerp(from_y, to_y, t)));
    }
    return points;
}

std::vector<GeoPoint> arc(double radius_m, double from_deg, double to_deg) {
    constexpr double rad = 0.0174532925;
    std::vector<GeoPoint> points;
    for (double deg = from_deg; deg <= to_deg + 0.1; deg += 5) {
        points.push_back(at(radius_m * std::sin(deg * rad), radius_m * std::cos(deg * rad)));
    }
    return points;
}

/// A town with a ring, a main road through it, side streets and a motorway that nobody drove.
MapScene town() {
    MapScene scene;
    scene.box = {at(-330, 0).lon_deg, at(0, -200).lat_deg, at(330, 0).lon_deg, at(0, 215).lat_deg};
    scene.title = "Straßenzustand 2026";
    scene.subtitle = "2026-03-01 to 2026-04-02  ·  6.4 km  ·  12 trips  ·  3 cars";
    scene.attribution = "© OpenStreetMap contributors";
    scene.class_km = {3.1, 2.2, 1.1};
    add(scene,
        {.name = "Europastraße", .rank = 0, .first_class = -1},
        straight(-420, 160, 420, 260));
    add(scene, {.name = "Széchenyi út", .rank = 1, .certain = false}, straight(-420, -60, 420, 30));
    add(scene, {.name = "Ringstraße", .rank = 2, .first_class = 1}, arc(150, 20, 340));
    add(scene, {.name = "Λεωφόρος Νίκης", .first_class = 1}, straight(-40, -230, 30, 160));
    add(scene, {.name = "Am Hang", .both_ways = false}, straight(150, -180, 260, 10));
    add(scene, {.name = "Weg 12", .rank = 5, .first_class = -1}, straight(-300, -200, -160, -40));
    add(scene,
        {.name = "Mühlgasse", .first_class = 1, .few_passes = true},
        straight(-300, 70, -150, 150));
    return scene;
}

struct Case {
    std::string name;
    MapStyle style;
    int width_px, height_px;
    const char* crs = nullptr;
};

const std::array cases{
    Case{"map-light", {}, 480, 360},
    Case{"map-dark-left-hand-inches",
         {.theme = MapStyle::Theme::dark,
          .ramp = "cividis",
          .left_hand_traffic = true,
          .in_per_mi = true},
         480,
         360},
    Case{"map-print-sweref", {.theme = MapStyle::Theme::print}, 480, 360, "EPSG:3006"},
    Case{"map-upright-without-legend", {.labels = false, .legend = false}, 300, 400},
};

Image drawn(const Case& of) {
    auto scene = town();
    auto style = of.style;
    style.min_passes = 3;
    if (of.crs != nullptr) {
        scene.projection = plane_projection(of.crs);
    }
    return render_map(scene, style, {of.width_px, of.height_px});
}

std::string text_libraries() {
    FT_Library library = nullptr;
    EXPECT_EQ(FT_Init_FreeType(&library), 0);
    int major = 0, minor = 0, patch = 0;
    FT_Library_Version(library, &major, &minor, &patch);
    FT_Done_FreeType(library);
    return "FreeType " + std::to_string(major) + "." + std::to_string(minor) + "." +
           std::to_string(patch) + ", HarfBuzz " + hb_version_string();
}

} // namespace

TEST(MapGolden, WholeMapsAreThoseThatWereFoundGood) {
    const auto version = mesa();
    const auto text = text_libraries();
    const bool same = version.find(golden_mesa) != std::string::npos && text == golden_text;
    for (const auto& of : cases) {
        const auto image = drawn(of);
        leave(of.name, image);
        const auto kept = golden(of.name);
        const auto words = "tests/data/golden/" + of.name + ".png was drawn by " + golden_mesa +
                           ", " + golden_text + ", and this is '" + version + "', " + text +
                           "; others may differ by a level on average. "
                           "MACADAM_LEAVE_PICTURES=FOLDER leaves there what was drawn";
        if (same) {
            EXPECT_EQ(max_difference(image, kept), 0) << words;
        } else {
            EXPECT_LE(mean_difference(image, kept), other_mean_levels) << words;
        }
    }
}

TEST(MapGolden, OsmesaAndEglDrawTheSameMaps) {
    for (const auto& of : cases) {
        expect_same_by_both_libraries(of.name, [&] { return drawn(of); });
    }
}

} // namespace macadam::testing
