#include "render/report/figures.hpp"

#include "render/report/common_parts.hpp"
#include "render/scene/nice_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace macadam {

using namespace document;

namespace {

// Place of the columns within a histogram, in its own units.
constexpr double left = 40;
constexpr double right_margin = 8;
constexpr double top = 24;
constexpr double bottom_margin = 44;

double sum_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Axes of the figure.
struct Axes {
    double max_iri; ///< mm/m
    double max_km;  ///< or mi
    double step_km;
    double right, bottom;

    double x(double iri) const { return left + (right - left) * std::min(iri / max_iri, 1.0); }
    double y(double km) const { return bottom - (bottom - top) * km / max_km; }
};

Axes axes_of(const IriHistogram& histogram, const Localisation& say, const HistogramSize& size) {
    double max_km = 0;
    for (const auto& bin : histogram.length_m) {
        max_km = std::max(max_km, say.long_length(sum_of(bin)));
    }
    const double step_km = nice_step(std::max(max_km, 0.001), 4);
    return {histogram.step_mm_per_m * static_cast<double>(histogram.length_m.size()),
            step_km * std::ceil(max_km / step_km - 1e-9),
            step_km,
            size.width - right_margin,
            size.height - bottom_margin};
}

/// Returns the step between two numbers under the axis, in the report's unit.
double iri_step(const Axes& axes, IriUnit unit) {
    return unit == IriUnit::mm_per_m ? (axes.max_iri > 8 ? 2 : 1)
                                     : nice_step(in_unit(axes.max_iri, unit), 6);
}

void add_grid(Drawing& drawing, const Axes& axes, const Localisation& say) {
    const auto [right, bottom] = std::pair{axes.right, axes.bottom};
    const int lines = static_cast<int>(std::lround(axes.max_km / axes.step_km));
    for (int i = 0; i <= lines; ++i) {
        const double y = axes.y(i * axes.step_km);
        drawing.shapes.emplace_back(Stroke{StrokeLook::grid, {{left, y}, {right, y}}});
        drawing.shapes.emplace_back(
            Label{left - 6, y + 4, Anchor::end, say.shortest(i * axes.step_km)});
    }
    const double per_mm_per_m = in_unit(1, say.unit);
    const double step = iri_step(axes, say.unit);
    const double most = axes.max_iri * per_mm_per_m;
    for (double iri = 0; iri < most - 0.7 * step; iri += step) {
        drawing.shapes.emplace_back(
            Label{axes.x(iri / per_mm_per_m), bottom + 16, Anchor::middle, say.shortest(iri)});
    }
    drawing.shapes.emplace_back(
        Label{right,
              bottom + 16,
              Anchor::end,
              (say.unit == IriUnit::mm_per_m ? say.shortest(most) : say.whole(most)) + " +"});
    drawing.shapes.emplace_back(
        Label{(left + right) / 2,
              bottom + 36,
              Anchor::middle,
              say("histogram.axis", {{"unit", std::string{say.iri_unit()}}})});
    drawing.shapes.emplace_back(Label{2, 12, Anchor::start, say.long_unit()});
}

/// Returns what a part of a column stands for: "IRI 2.50 – 2.75, Fair: 1.20 km".
std::string bin_words(const Report& report, std::size_t bin, std::size_t c, double km) {
    const auto& say = report.wording;
    const double from = report.histogram.step_mm_per_m * static_cast<double>(bin);
    return fmt::format("IRI {}{}, {}: {} {}",
                       bin + 1 < report.histogram.length_m.size()
                           ? say.interval(from, from + report.histogram.step_mm_per_m)
                           : say.iri(from),
                       bin + 1 < report.histogram.length_m.size() ? "" : " +",
                       class_name(report, c),
                       say.number(km, 2),
                       say.long_unit());
}

void add_bars(Drawing& drawing, const Axes& axes, const Report& report) {
    const auto& bins = report.histogram.length_m;
    const double bar = (axes.right - left) / static_cast<double>(bins.size());
    for (std::size_t bin = 0; bin < bins.size(); ++bin) {
        double below_km = 0;
        for (std::size_t c = 0; c < report.colours.size(); ++c) {
            const double km = report.wording.long_length(bins[bin][c]);
            if (km > 0) {
                Bar part{left + bar * static_cast<double>(bin) + 0.5,
                         axes.y(below_km + km),
                         bar - 1,
                         axes.y(below_km) - axes.y(below_km + km),
                         report.colours[c]};
                part.words = bin_words(report, bin, c, km);
                drawing.shapes.emplace_back(std::move(part));
            }
            below_km += km;
        }
    }
}

void add_mean(Drawing& drawing, const Axes& axes, double iri, const Localisation& say) {
    const double x = axes.x(iri);
    const bool at_right = x > (left + axes.right) / 2;
    drawing.shapes.emplace_back(Stroke{StrokeLook::mean, {{x, top - 12}, {x, axes.bottom}}});
    drawing.shapes.emplace_back(Label{x + (at_right ? -5 : 5),
                                      top - 4,
                                      at_right ? Anchor::end : Anchor::start,
                                      say("histogram.mean", {{"iri", say.iri(iri)}})});
}

} // namespace

Cell share_bar(const Report& report, const RoadSummary& roads) {
    Cell cell{""};
    if (roads.covered_m <= 0) {
        return cell;
    }
    std::string words;
    for (std::size_t c = 0; c < report.colours.size(); ++c) {
        const double share = 100 * roads.classes[c].length_m / roads.covered_m;
        words += fmt::format("{}{} {}",
                             c > 0 ? ", " : "",
                             class_name(report, c),
                             report.wording.whole_percent(share, 100));
        cell.shares.push_back({share, report.colours[c]});
    }
    cell.text = words;
    return cell;
}

Drawing histogram_drawing(const Report& report, const HistogramSize& size) {
    const auto& say = report.wording;
    const auto axes = axes_of(report.histogram, say, size);
    const double mean = report.summary.all.mean.iri;
    Drawing drawing{size.width, size.height, say("histogram.words", {{"iri", say.iri(mean)}}), {}};
    for (std::size_t c = 0; c < report.colours.size(); ++c) {
        double km = 0;
        for (const auto& bin : report.histogram.length_m) {
            km += say.long_length(bin[c]);
        }
        drawing.words +=
            fmt::format(", {} {} {}", class_name(report, c), say.number(km, 2), say.long_unit());
    }
    add_grid(drawing, axes, say);
    add_bars(drawing, axes, report);
    add_mean(drawing, axes, mean, say);
    return drawing;
}

} // namespace macadam
