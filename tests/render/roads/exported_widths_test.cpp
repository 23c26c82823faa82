// Widths in the styles of exports, against those of the renderer.

#include "render/roads/line_widths.hpp"
#include "storage/styles/road_style.hpp"
#include "support/files/files.hpp"
#include "support/program/shell.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <sstream>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;

constexpr double mm_per_inch = 25.4;
constexpr double dpi = 300;
constexpr double px_mm = mm_per_inch / dpi;

/// Evaluates the first four expressions of a QGIS style at a scale: width and offset of the casing
/// and of the line, mm.
constexpr const char* evaluation = R"py(
import html, re, sys
style = open(sys.argv[1]).read()
for text in re.findall('name="expression" value="([^"]*)"', style)[:4]:
    text = html.unescape(text).replace("if(", "choose(").replace("^", "**")
    print(eval(text.replace("@map_scale", sys.argv[2]), {"max": max, "min": min,
        "choose": lambda holds, then, other: then if holds else other}))
)py";

struct QgisWidths {
    double casing_mm, casing_offset_mm, core_mm, core_offset_mm;
};

TEST(QgisStyle, HasTheWidthsOfTheRendererAtEveryScale) {
    const auto folder = test_folder();
    written(folder, "roads.qml", qml_style({*class_table("fhwa")}));
    written(folder, "evaluate.py", evaluation);
    for (const int denominator : {1000, 5000, 25000, 70000, 75000, 250000, 1000000}) {
        std::istringstream values{
            output_of(folder,
                      fmt::format("/usr/bin/python3 {0}/evaluate.py {0}/roads.qml {1}",
                                  folder.string(),
                                  denominator))};
        QgisWidths qgis{};
        ASSERT_TRUE(values >> qgis.casing_mm >> qgis.casing_offset_mm >> qgis.core_mm >>
                    qgis.core_offset_mm);
        const auto ours = line_widths(denominator * px_mm / 1000, dpi / 96);
        constexpr int medium_rank = 3;
        const double offset_px = ours.separate_ways ? way_offset_px(ours, medium_rank) : 0;
        constexpr double rounding_mm = 0.002; // of the expression's four figures
        EXPECT_NEAR(qgis.core_mm, ours.core_px * px_mm, rounding_mm) << denominator;
        EXPECT_NEAR(qgis.casing_mm, (ours.core_px + 2 * ours.casing_px) * px_mm, rounding_mm)
            << denominator;
        EXPECT_NEAR(qgis.core_offset_mm, offset_px * px_mm, rounding_mm) << denominator;
        EXPECT_DOUBLE_EQ(qgis.casing_offset_mm, qgis.core_offset_mm) << denominator;
    }
}

TEST(SldStyle, HasTheWidthsOfTilesAtTheirZooms) {
    const auto sld = sld_style({*class_table("fhwa")}, "roads");
    for (const int zoom : {10, 13, 16, 17}) {
        EXPECT_THAT(sld,
                    HasSubstr(fmt::format(R"("stroke-width">{:.2f}<)", tile_widths(zoom).core_px)));
    }
    // Halfway from zoom 12 to 13, at pixels of 0.28 mm: 559,082,264 at zoom 0 (OGC 17-083r2).
    EXPECT_THAT(sld, HasSubstr("<se:MinScaleDenominator>96516</se:MinScaleDenominator>"));
    EXPECT_THAT(sld, HasSubstr("<se:MaxScaleDenominator>96516</se:MaxScaleDenominator>"));
}

} // namespace
} // namespace macadam::testing
