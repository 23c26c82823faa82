#pragma once

#include <span>
#include <string>
#include <vector>

namespace macadam {

/// Line of a chart: points (x, y) in drawing order; x and y have the same size.
struct ChartLine {
    enum class Look : unsigned char { solid, dashed, faint, dots };

    std::string name; ///< in the legend; empty: not listed
    std::vector<double> x;
    std::vector<double> y;
    Look look = Look::solid; ///< distinguishable without colour
};

/// Pair of axes with its lines. y begins at 0, x at the start of the lines.
struct ChartPanel {
    std::string title;
    std::string x_label; ///< with unit
    std::string y_label;
    std::vector<ChartLine> lines; ///< at least one with two points or more; y >= 0
};

/// Returns an SVG file of stacked panels. It is self-contained (no external style sheet, font or
/// script) and black on white for print.
std::string line_charts_svg(std::span<const ChartPanel> panels);

} // namespace macadam
