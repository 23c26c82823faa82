#include "render/report/document/line_chart.hpp"

#include <gmock/gmock.h>

namespace macadam::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

ChartPanel panel_of(std::vector<double> y) {
    return {.title = "Title <1>",
            .x_label = "frequency, Hz",
            .y_label = "amplitude",
            .lines = {{"measured & more", {0, 5, 10}, std::move(y), ChartLine::Look::solid}}};
}

/// The axes reach from 66 to 704 and from 286 up to 60.
TEST(LineChart, PutsPointsWhereTheAxesSay) {
    const std::vector panels{panel_of({0, 50, 100})};
    EXPECT_THAT(line_charts_svg(panels),
                HasSubstr("points=\"66.0,286.0 385.0,173.0 704.0,60.0 \""));
}

TEST(LineChart, LabelsRoundValues) {
    const std::vector panels{panel_of({0, 0.3, 0.9})};
    const auto svg = line_charts_svg(panels);
    for (const char* label : {">0<", ">0.2<", ">0.8<", ">1<", ">4<", ">10<"}) {
        EXPECT_THAT(svg, HasSubstr(label));
    }
}

TEST(LineChart, EscapesItsTexts) {
    const std::vector panels{panel_of({0, 1, 2})};
    const auto svg = line_charts_svg(panels);
    EXPECT_THAT(svg, HasSubstr("Title &lt;1&gt;"));
    EXPECT_THAT(svg, HasSubstr("measured &amp; more"));
    EXPECT_THAT(svg, Not(HasSubstr("<1>")));
}

TEST(LineChart, StacksItsPanels) {
    const std::vector panels{panel_of({0, 1, 2}), panel_of({0, 1, 2})};
    const auto svg = line_charts_svg(panels);
    EXPECT_THAT(svg, HasSubstr("viewBox=\"0 0 720 680\""));
    EXPECT_THAT(svg, HasSubstr("704.0,400.0 ")); // 340 below the first's
}

TEST(LineChart, SetsDotsWhereTheAxesSay) {
    auto panel = panel_of({0, 50, 100});
    panel.lines.front().look = ChartLine::Look::dots;
    const std::vector panels{panel};
    EXPECT_THAT(line_charts_svg(panels),
                AllOf(HasSubstr("<circle cx=\"385.0\" cy=\"173.0\""), Not(HasSubstr("points="))));
}

TEST(LineChart, LeavesLinesWithoutANameOutOfTheLegend) {
    auto panel = panel_of({0, 50, 100});
    const std::vector named{panel};
    panel.lines.push_back({"", {0, 10}, {1, 2}, ChartLine::Look::solid});
    const std::vector both{panel};
    const auto lines_of = [](const std::string& svg) {
        std::size_t count = 0;
        for (auto at = svg.find("<line "); at != std::string::npos;
             at = svg.find("<line ", at + 1)) {
            ++count;
        }
        return count;
    };
    EXPECT_EQ(lines_of(line_charts_svg(both)), lines_of(line_charts_svg(named)));
}

TEST(LineChart, OfZerosIsALineOnTheAxis) {
    const std::vector panels{panel_of({0, 0, 0})};
    EXPECT_THAT(line_charts_svg(panels),
                HasSubstr("points=\"66.0,286.0 385.0,286.0 704.0,286.0 \""));
}

} // namespace
} // namespace macadam::testing
