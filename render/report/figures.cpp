#include "render/report/figures.hpp"

#include "render/nice_step.hpp"
#include "render/report/html.hpp"
#include "render/report/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace macadam {
namespace {

// Sizes of the histogram in its own units; a phone shows 400 of them on about 330 px.
constexpr double width = 400;
constexpr double height = 230;
constexpr double left = 40;
constexpr double right = 392;
constexpr double top = 24;
constexpr double bottom = 186;
constexpr double text_size = 12;

double sum_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

std::string label(double x, double y, const char* anchor, const std::string& text) {
    return fmt::format(
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, text);
}

/// Where values stand in the figure.
struct Axes {
    double most_iri;
    double most_km;
    double step_km;

    double x(double iri) const { return left + (right - left) * std::min(iri / most_iri, 1.0); }
    double y(double km) const { return bottom - (bottom - top) * km / most_km; }
};

Axes axes_of(const IriHistogram& histogram) {
    double most_km = 0;
    for (const auto& bin : histogram.length_m) {
        most_km = std::max(most_km, sum_of(bin) / 1000);
    }
    const double step_km = nice_step(std::max(most_km, 0.001), 4);
    return {histogram.step_mm_per_m * static_cast<double>(histogram.length_m.size()),
            step_km * std::ceil(most_km / step_km - 1e-9),
            step_km};
}

std::string grid_svg(const Axes& axes) {
    std::string svg;
    const int lines = static_cast<int>(std::lround(axes.most_km / axes.step_km));
    for (int i = 0; i <= lines; ++i) {
        const double y = axes.y(i * axes.step_km);
        svg +=
            fmt::format("<line class=\"grid\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>\n",
                        left,
                        right,
                        y,
                        y);
        svg += label(left - 6, y + 4, "end", fmt::format("{:g}", i * axes.step_km));
    }
    const double iri_step = axes.most_iri > 8 ? 2 : 1;
    for (double iri = 0; iri < axes.most_iri - 0.5 * iri_step; iri += iri_step) {
        svg += label(axes.x(iri), bottom + 16, "middle", fmt::format("{:g}", iri));
    }
    return svg + label(right, bottom + 16, "end", fmt::format("{:g} +", axes.most_iri)) +
           label((left + right) / 2, bottom + 36, "middle", "IRI of a segment, mm/m") +
           label(2, 12, "start", "km");
}

std::string
bars_svg(const IriHistogram& histogram, const Axes& axes, std::span<const std::uint32_t> colours) {
    const double bar = (right - left) / static_cast<double>(histogram.length_m.size());
    std::string svg;
    for (std::size_t bin = 0; bin < histogram.length_m.size(); ++bin) {
        double below_km = 0;
        for (std::size_t c = 0; c < colours.size(); ++c) {
            const double km = histogram.length_m[bin][c] / 1000;
            if (km > 0) {
                svg += fmt::format("<rect class=\"bar\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" "
                                   "height=\"{:.2f}\" fill=\"#{:06x}\"/>\n",
                                   left + bar * static_cast<double>(bin) + 0.5,
                                   axes.y(below_km + km),
                                   bar - 1,
                                   axes.y(below_km) - axes.y(below_km + km),
                                   colours[c]);
            }
            below_km += km;
        }
    }
    return svg;
}

std::string mean_svg(const Axes& axes, double iri) {
    const double x = axes.x(iri);
    const bool at_right = x > (left + right) / 2;
    return fmt::format(
               "<line class=\"mean\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>\n",
               x,
               top - 12,
               bottom) +
           label(x + (at_right ? -5 : 5),
                 top - 4,
                 at_right ? "end" : "start",
                 fmt::format("mean {}", iri_text(iri)));
}

} // namespace

std::string swatch_svg(std::uint32_t rgb) {
    return fmt::format("<svg class=\"swatch\" viewBox=\"0 0 10 10\" aria-hidden=\"true\">"
                       "<rect class=\"bar\" width=\"10\" height=\"10\" fill=\"#{:06x}\"/></svg>",
                       rgb);
}

std::string share_bar_svg(const RoadSummary& roads,
                          const ClassTable& classes,
                          std::span<const std::uint32_t> colours) {
    if (roads.covered_m <= 0) {
        return {};
    }
    std::string words, rects;
    double x = 0;
    for (std::size_t c = 0; c < colours.size(); ++c) {
        const double share = 100 * roads.classes[c].length_m / roads.covered_m;
        words += fmt::format(
            "{}{} {:.0f} %", c > 0 ? ", " : "", escaped(classes.classes[c].name), share);
        if (share > 0) {
            rects += fmt::format("<rect x=\"{:.2f}\" width=\"{:.2f}\" height=\"10\" "
                                 "fill=\"#{:06x}\"/>",
                                 x,
                                 share,
                                 colours[c]);
        }
        x += share;
    }
    return fmt::format("<svg class=\"share\" viewBox=\"0 0 100 10\" preserveAspectRatio=\"none\" "
                       "role=\"img\" aria-label=\"{}\">{}</svg>",
                       words,
                       rects);
}

std::string histogram_svg(const IriHistogram& histogram,
                          const RoadMean& mean,
                          const ClassTable& classes,
                          std::span<const std::uint32_t> colours) {
    const auto axes = axes_of(histogram);
    std::string words;
    for (std::size_t c = 0; c < colours.size(); ++c) {
        double km = 0;
        for (const auto& bin : histogram.length_m) {
            km += bin[c] / 1000;
        }
        words += fmt::format(", {} {:.2f} km", escaped(classes.classes[c].name), km);
    }
    return fmt::format("<svg class=\"histogram\" viewBox=\"0 0 {} {}\" role=\"img\" "
                       "font-size=\"{}\" aria-label=\"Histogram of IRI by length of road: mean "
                       "{}{}\">\n{}{}{}</svg>\n",
                       width,
                       height,
                       text_size,
                       iri_text(mean.iri),
                       words,
                       grid_svg(axes),
                       bars_svg(histogram, axes, colours),
                       mean_svg(axes, mean.iri));
}

} // namespace macadam
