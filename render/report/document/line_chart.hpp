#pragma once

#include <span>
#include <string>
#include <vector>

namespace macadam {

/// One line of a chart: points (x, y) in the order of drawing, as many of both.
struct ChartLine {
    enum class Look : unsigned char { solid, dashed, faint, dots };

    std::string name; ///< in the legend; empty: not there
    std::vector<double> x;
    std::vector<double> y;
    Look look = Look::solid; ///< told apart without colour
};

/// One pair of axes with its lines. y begins at 0, x where the lines do.
struct ChartPanel {
    std::string title;
    std::string x_label; ///< with its unit
    std::string y_label;
    std::vector<ChartLine> lines; ///< at least one of two points or more; y >= 0
};

/// Panels one under the other as an SVG file of its own: no style sheet, font or script from
/// elsewhere, black on white for print.
std::string line_charts_svg(std::span<const ChartPanel> panels);

} // namespace macadam
