#include "render/report/reference_figures.hpp"

#include "render/nice_step.hpp"
#include "render/report/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

namespace macadam {
namespace {

constexpr const char* ink = "#2c7bb6"; // of the best class of the default ramp: readable on both
                                       // light and dark pages

std::string label(double x, double y, const char* anchor, const std::string& text) {
    return fmt::format(
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, text);
}

std::string line(const char* look, double x1, double y1, double x2, double y2) {
    return fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" "
                       "y2=\"{:.1f}\"/>\n",
                       look,
                       x1,
                       y1,
                       x2,
                       y2);
}

// ------------------------------------------------------------------------------------- scatter

constexpr double scatter_left = 40;
constexpr double scatter_top = 12;
constexpr double scatter_size = 340;

struct Square {
    double most; ///< mm/m, of both axes

    double x(double iri) const { return scatter_left + scatter_size * iri / most; }
    double y(double iri) const { return scatter_top + scatter_size * (1 - iri / most); }
};

Square square_of(std::span<const SurveyPair> pairs) {
    double most = 1;
    for (const auto& pair : pairs) {
        most = std::max({most, pair.survey, pair.trip});
    }
    return {std::ceil(most)};
}

std::string scatter_axes(const Square& square) {
    const double step = nice_step(square.most, 6);
    std::string svg;
    for (double iri = 0; iri <= square.most + 1e-9; iri += step) {
        svg += line("grid", square.x(0), square.y(iri), square.x(square.most), square.y(iri));
        svg += label(scatter_left - 6, square.y(iri) + 4, "end", fmt::format("{:g}", iri));
        svg += label(square.x(iri), square.y(0) + 16, "middle", fmt::format("{:g}", iri));
    }
    return svg +
           line("mean", square.x(0), square.y(0), square.x(square.most), square.y(square.most));
}

/// Dots on a grid of half a unit, each once.
std::string dots(std::span<const SurveyPair> pairs, const Square& square) {
    std::set<std::pair<long, long>> places;
    for (const auto& pair : pairs) {
        places.emplace(std::lround(2 * square.x(pair.survey)),
                       std::lround(2 * square.y(pair.trip)));
    }
    std::string path;
    for (const auto& [x, y] : places) {
        path += fmt::format("M{:g} {:g}h0", static_cast<double>(x) / 2, static_cast<double>(y) / 2);
    }
    return fmt::format("<path d=\"{}\" stroke=\"{}\" stroke-width=\"3\" stroke-linecap=\"round\" "
                       "stroke-opacity=\"0.6\" fill=\"none\"/>\n",
                       path,
                       ink);
}

// ---------------------------------------------------------------------------------- differences

constexpr double panel_width = 190;
constexpr double panel_height = 150;
constexpr double plot_top = 22;
constexpr double plot_bottom = 116;
constexpr double plot_left = 8;
constexpr double plot_right = 182;
constexpr int bins = 30;
constexpr double reach_sds = 3.5;
constexpr double least_reach_mm_per_m = 0.1;

/// The differences of a band between -reach and reach, and the curve of their mean and sd.
struct Panel {
    SurveyScore score;
    double reach; ///< mm/m
    std::vector<double> share;

    double x(double difference) const {
        const double middle = (plot_left + plot_right) / 2;
        return middle + (plot_right - plot_left) / 2 * difference / reach;
    }
    static double y(double share_of_most) {
        return plot_bottom - (plot_bottom - plot_top) * std::min(share_of_most, 1.0);
    }
};

Panel panel_of(std::span<const SurveyPair> pairs, const SurveyScore& score) {
    const double sd = std::isnan(score.sd) ? 0 : score.sd;
    const double far = std::max(least_reach_mm_per_m, std::abs(score.bias) + reach_sds * sd);
    const double step = nice_step(far, 4);
    Panel panel{score, step * std::ceil(far / step), std::vector<double>(bins, 0.0)};
    for (const auto& pair : pairs) {
        if (pair.survey >= score.from_mm_per_m && pair.survey < score.to_mm_per_m) {
            const double place = (pair.trip - pair.survey + panel.reach) / (2 * panel.reach);
            const auto bin = static_cast<int>(std::floor(place * bins));
            panel.share[static_cast<std::size_t>(std::clamp(bin, 0, bins - 1))] +=
                1 / static_cast<double>(score.pieces);
        }
    }
    return panel;
}

/// Share of a bin by the normal curve.
double curve(const Panel& panel, double difference) {
    const double z = (difference - panel.score.bias) / panel.score.sd;
    const double density =
        std::exp(-z * z / 2) / (panel.score.sd * std::sqrt(2 * std::numbers::pi));
    return density * 2 * panel.reach / bins;
}

std::string band_text(const SurveyScore& score) {
    return std::isinf(score.to_mm_per_m)
               ? fmt::format("{:g} and more", score.from_mm_per_m)
               : fmt::format("{:g} to {:g}", score.from_mm_per_m, score.to_mm_per_m);
}

std::string curve_svg(const Panel& panel, double most) {
    if (!(panel.score.sd > 0)) {
        return {};
    }
    std::string points;
    for (int i = 0; i <= 2 * bins; ++i) {
        const double difference = panel.reach * (static_cast<double>(i) / bins - 1);
        points += fmt::format(
            "{:.1f},{:.1f} ", panel.x(difference), Panel::y(curve(panel, difference) / most));
    }
    return fmt::format("<polyline points=\"{}\" fill=\"none\" class=\"grid\" "
                       "stroke-width=\"1.5\"/>\n",
                       points);
}

std::string panel_svg(const Panel& panel) {
    double most = *std::ranges::max_element(panel.share);
    if (panel.score.sd > 0) {
        most = std::max(most, curve(panel, panel.score.bias));
    }
    std::string svg;
    const double bar = (plot_right - plot_left) / bins;
    for (int i = 0; i < bins; ++i) {
        const double share = panel.share[static_cast<std::size_t>(i)];
        if (share > 0) {
            const double top = Panel::y(share / most);
            svg += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" "
                               "height=\"{:.2f}\" fill=\"{}\"/>\n",
                               plot_left + bar * i + 0.3,
                               top,
                               bar - 0.6,
                               plot_bottom - top,
                               ink);
        }
    }
    svg += curve_svg(panel, most);
    svg += line("mean", panel.x(0), plot_top - 4, panel.x(0), plot_bottom);
    svg += line("grid", plot_left, plot_bottom, plot_right, plot_bottom);
    for (const double difference : {-panel.reach, 0.0, panel.reach}) {
        svg += label(panel.x(difference),
                     plot_bottom + 14,
                     difference < 0   ? "start"
                     : difference > 0 ? "end"
                                      : "middle",
                     fmt::format("{:g}", difference));
    }
    return svg + label(plot_left,
                       12,
                       "start",
                       fmt::format("{} mm/m, {}", band_text(panel.score), panel.score.pieces));
}

} // namespace

std::string scatter_svg(std::span<const SurveyPair> pairs) {
    const auto square = square_of(pairs);
    return fmt::format("<svg class=\"histogram\" viewBox=\"0 0 392 396\" role=\"img\" "
                       "font-size=\"12\" aria-label=\"IRI of the cars over IRI of the reference, "
                       "{} pieces of road, 0 to {:g} mm/m\">\n{}{}{}{}</svg>\n",
                       pairs.size(),
                       square.most,
                       scatter_axes(square),
                       dots(pairs, square),
                       label(scatter_left + scatter_size / 2,
                             scatter_top + scatter_size + 36,
                             "middle",
                             "IRI of the reference, mm/m"),
                       label(scatter_left + 6, scatter_top + 12, "start", "IRI of the cars, mm/m"));
}

std::string differences_svg(std::span<const SurveyPair> pairs) {
    const auto scores = scores_by_band(pairs);
    std::string panels, words;
    for (std::size_t i = 0; i < scores.size(); ++i) {
        panels += fmt::format("<g transform=\"translate({:g} {:g})\">\n{}</g>\n",
                              panel_width * static_cast<double>(i % 2),
                              panel_height * static_cast<double>(i / 2),
                              panel_svg(panel_of(pairs, scores[i])));
        words += fmt::format("; {} mm/m: mean {:+.2f}, {} pieces",
                             band_text(scores[i]),
                             scores[i].bias,
                             scores[i].pieces);
    }
    const auto rows = static_cast<double>((scores.size() + 1) / 2);
    return fmt::format("<svg class=\"histogram\" viewBox=\"0 0 {:g} {:g}\" role=\"img\" "
                       "font-size=\"12\" aria-label=\"Histograms of the cars' IRI less the "
                       "reference's{}\">\n{}</svg>\n",
                       2 * panel_width,
                       panel_height * rows,
                       words,
                       panels);
}

} // namespace macadam
