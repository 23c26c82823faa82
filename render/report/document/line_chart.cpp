#include "render/report/document/line_chart.hpp"

#include "render/report/document/html.hpp"
#include "render/scene/colour.hpp"
#include "render/scene/nice_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

// In the figure's own units; 720 of them are 160 mm on a page.
constexpr double width = 720;
constexpr double panel_height = 340;
constexpr double left = 66;
constexpr double right = 704;
constexpr double top = 60;
constexpr double bottom = 286;
constexpr double text_size = 14;
constexpr double legend_line = 34;
constexpr double letter = 0.6 * text_size; // approximate letter width of a name in the legend

struct Axes {
    double from_x;
    double to_x;
    double to_y;
    double step_x;
    double step_y;
    double down; ///< vertical offset of the panel

    double x(double value) const {
        return left + (right - left) * (value - from_x) / (to_x - from_x);
    }
    double y(double value) const { return down + bottom - (bottom - top) * value / to_y; }
};

Axes axes_of(const ChartPanel& panel, double down) {
    double from_x = panel.lines.front().x.front();
    double to_x = from_x;
    double max_y = 0;
    for (const auto& line : panel.lines) {
        const auto [low, high] = std::ranges::minmax(line.x);
        from_x = std::min(from_x, low);
        to_x = std::max(to_x, high);
        max_y = std::max(max_y, std::ranges::max(line.y));
    }
    const double step_y = nice_step(std::max(max_y, 1e-9), 5);
    return {.from_x = from_x,
            .to_x = to_x,
            .to_y = step_y * std::max(1.0, std::ceil(max_y / step_y - 1e-9)),
            .step_x = nice_step(to_x - from_x, 10),
            .step_y = step_y,
            .down = down};
}

std::string
text_svg(double x, double y, const char* anchor, const std::string& text, const char* more = "") {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n",
                       x,
                       y,
                       anchor,
                       more,
                       escaped(text));
}

std::string rule_svg(double x1, double y1, double x2, double y2, std::uint32_t colour) {
    return fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#{:06x}\"/>\n",
        x1,
        y1,
        x2,
        y2,
        colour);
}

std::string frame_svg(const ChartPanel& panel, const Axes& axes, const Palette& colours) {
    std::string svg;
    const int rows = static_cast<int>(std::lround(axes.to_y / axes.step_y));
    for (int i = 0; i <= rows; ++i) {
        const double y = axes.y(i * axes.step_y);
        svg += rule_svg(left, y, right, y, i == 0 ? colours.ink : colours.border);
        svg += text_svg(left - 8, y + 5, "end", fmt::format("{:g}", i * axes.step_y));
    }
    for (int i = static_cast<int>(std::ceil(axes.from_x / axes.step_x - 1e-9));
         i * axes.step_x <= axes.to_x * (1 + 1e-9);
         ++i) {
        const double x = axes.x(i * axes.step_x);
        svg += rule_svg(x, axes.down + bottom, x, axes.down + bottom + 5, colours.ink);
        svg += text_svg(x, axes.down + bottom + 21, "middle", fmt::format("{:g}", i * axes.step_x));
    }
    const double middle = axes.down + (top + bottom) / 2;
    return svg + text_svg(left, axes.down + 22, "start", panel.title, " font-weight=\"bold\"") +
           text_svg((left + right) / 2, axes.down + bottom + 42, "middle", panel.x_label) +
           text_svg(16,
                    middle,
                    "middle",
                    panel.y_label,
                    fmt::format(" transform=\"rotate(-90 16 {:.1f})\"", middle).c_str());
}

/// Returns a stroke style in dark, blue or light; dashes and weight distinguish them in black and
/// white.
std::string stroke_of(ChartLine::Look look, const Palette& colours) {
    switch (look) {
    case ChartLine::Look::dashed:
        return "stroke=\"#0a5fb4\" stroke-width=\"2.2\" stroke-dasharray=\"7 4\"";
    case ChartLine::Look::faint:
        return fmt::format("stroke=\"#{:06x}\" stroke-width=\"1.2\" stroke-dasharray=\"2 3\"",
                           colours.quiet_ink);
    case ChartLine::Look::dots:
        return "stroke=\"#0a5fb4\" stroke-width=\"4\" stroke-opacity=\"0.5\" "
               "stroke-linecap=\"round\" stroke-dasharray=\"0 40\"";
    case ChartLine::Look::solid:
        break;
    }
    return fmt::format("stroke=\"#{:06x}\" stroke-width=\"1.6\"", colours.ink);
}

std::string dots_svg(const ChartLine& line, const Axes& axes) {
    std::string svg = "<g fill=\"#0a5fb4\" fill-opacity=\"0.5\">\n";
    for (std::size_t i = 0; i < line.x.size(); ++i) {
        svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2\"/>\n",
                           axes.x(line.x[i]),
                           axes.y(line.y[i]));
    }
    return svg + "</g>\n";
}

std::string line_svg(const ChartLine& line, const Axes& axes, const Palette& colours) {
    if (line.look == ChartLine::Look::dots) {
        return dots_svg(line, axes);
    }
    std::string points;
    for (std::size_t i = 0; i < line.x.size(); ++i) {
        points += fmt::format("{:.1f},{:.1f} ", axes.x(line.x[i]), axes.y(line.y[i]));
    }
    return fmt::format("<polyline fill=\"none\" stroke-linejoin=\"round\" {} points=\"{}\"/>\n",
                       stroke_of(line.look, colours),
                       points);
}

/// Draws the legend in a row between title and axes, where it hides no data.
std::string legend_svg(const ChartPanel& panel, double down, const Palette& colours) {
    const double y = down + 42;
    double x = left;
    std::string svg;
    for (const auto& line : panel.lines) {
        if (line.name.empty()) {
            continue;
        }
        svg += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n",
                           x,
                           y,
                           x + legend_line,
                           y,
                           stroke_of(line.look, colours));
        svg += text_svg(x + legend_line + 6, y + 5, "start", line.name);
        x += legend_line + 30 + letter * static_cast<double>(line.name.size());
    }
    return svg;
}

} // namespace

std::string line_charts_svg(std::span<const ChartPanel> panels) {
    const auto colours = palette(MapStyle::Theme::print);
    const double height = panel_height * static_cast<double>(panels.size());
    auto svg = fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" "
                           "width=\"{0}\" height=\"{1}\" font-size=\"{2}\" "
                           "font-family=\"'Noto Sans', Verdana, Arial, sans-serif\" "
                           "fill=\"#{3:06x}\">\n<rect width=\"{0}\" height=\"{1}\" "
                           "fill=\"#ffffff\"/>\n",
                           width,
                           height,
                           text_size,
                           colours.ink);
    double down = 0;
    for (const auto& panel : panels) {
        const auto axes = axes_of(panel, down);
        svg += frame_svg(panel, axes, colours);
        for (const auto& line : panel.lines) {
            svg += line_svg(line, axes, colours);
        }
        svg += legend_svg(panel, down, colours);
        down += panel_height;
    }
    return svg + "</svg>\n";
}

} // namespace macadam
