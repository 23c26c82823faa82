#include "render/report/reference_figures.hpp"

#include "render/scene/nice_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

namespace macadam {

using namespace document;

namespace {

constexpr std::uint32_t ink = 0x2c7bb6; // default ramp, readable on light and dark pages

// ------------------------------------------------------------------------------------- scatter

constexpr double scatter_left = 40;
constexpr double scatter_top = 12;
constexpr double scatter_size = 340;

struct Square {
    double most; ///< mm/m, of both axes

    double x(double iri) const { return scatter_left + scatter_size * iri / most; }
    double y(double iri) const { return scatter_top + scatter_size * (1 - iri / most); }
};

/// Returns the square that contains all intervals, up to a round number of the unit.
Square square_of(std::span<const SurveyPair> pairs, const Localisation& say) {
    double most = 1;
    for (const auto& pair : pairs) {
        most = std::max({most, pair.survey, pair.trip});
    }
    if (say.unit == IriUnit::mm_per_m) {
        return {std::ceil(most)};
    }
    const double a_unit = in_unit(1, say.unit);
    const double step = nice_step(most * a_unit, 6);
    return {step * std::ceil(most * a_unit / step) / a_unit};
}

void add_axes(Drawing& drawing, const Square& square, const Localisation& say) {
    const double a_unit = in_unit(1, say.unit);
    const double step = nice_step(square.most * a_unit, 6);
    for (int i = 0; i * step <= square.most * a_unit + 1e-9; ++i) {
        const double iri = i * step / a_unit;
        const auto text = say.shortest(i * step);
        drawing.shapes.emplace_back(
            Stroke{StrokeLook::grid,
                   {{square.x(0), square.y(iri)}, {square.x(square.most), square.y(iri)}}});
        drawing.shapes.emplace_back(Label{scatter_left - 6, square.y(iri) + 4, Anchor::end, text});
        drawing.shapes.emplace_back(Label{square.x(iri), square.y(0) + 16, Anchor::middle, text});
    }
    drawing.shapes.emplace_back(
        Stroke{StrokeLook::mean,
               {{square.x(0), square.y(0)}, {square.x(square.most), square.y(square.most)}}});
}

/// Returns the dots on a grid of half a unit, without duplicates.
Dots dots(std::span<const SurveyPair> pairs, const Square& square) {
    std::set<std::pair<long, long>> places;
    for (const auto& pair : pairs) {
        places.emplace(std::lround(2 * square.x(pair.survey)),
                       std::lround(2 * square.y(pair.trip)));
    }
    Dots dots{{}, 3, ink};
    for (const auto& [x, y] : places) {
        dots.places.emplace_back(static_cast<double>(x) / 2, static_cast<double>(y) / 2);
    }
    return dots;
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
constexpr double min_reach_mm_per_m = 0.1;

/// Histogram of a band's differences between -reach and reach, and the normal curve of their mean
/// and sd.
struct Panel {
    SurveyScore score;
    double reach; ///< mm/m, a round number of the page's unit
    std::vector<double> share;

    double x(double difference) const {
        const double middle = (plot_left + plot_right) / 2;
        return middle + (plot_right - plot_left) / 2 * difference / reach;
    }
    static double y(double share_of_most) {
        return plot_bottom - (plot_bottom - plot_top) * std::min(share_of_most, 1.0);
    }
};

Panel panel_of(std::span<const SurveyPair> pairs,
               const SurveyScore& score,
               const Localisation& say) {
    const double a_unit = in_unit(1, say.unit);
    const double sd = std::isnan(score.sd) ? 0 : score.sd;
    const double far = std::max(min_reach_mm_per_m, std::abs(score.bias) + reach_sds * sd);
    const double step = nice_step(far * a_unit, 4) / a_unit;
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

/// Returns the share of a bin under the normal curve.
double curve(const Panel& panel, double difference) {
    const double z = (difference - panel.score.bias) / panel.score.sd;
    const double density =
        std::exp(-z * z / 2) / (panel.score.sd * std::sqrt(2 * std::numbers::pi));
    return density * 2 * panel.reach / bins;
}

/// Corner of a panel in the figure.
struct Corner {
    double x;
    double y;
};

void add_curve(Drawing& drawing, const Panel& panel, const Corner& corner, double most) {
    if (!(panel.score.sd > 0)) {
        return;
    }
    Stroke stroke{StrokeLook::curve, {}};
    for (int i = 0; i <= 2 * bins; ++i) {
        const double difference = panel.reach * (static_cast<double>(i) / bins - 1);
        stroke.points.emplace_back(corner.x + panel.x(difference),
                                   corner.y + Panel::y(curve(panel, difference) / most));
    }
    drawing.shapes.emplace_back(std::move(stroke));
}

void add_bars(Drawing& drawing, const Panel& panel, const Corner& corner, double most) {
    const double bar = (plot_right - plot_left) / bins;
    for (int i = 0; i < bins; ++i) {
        const double share = panel.share[static_cast<std::size_t>(i)];
        if (share > 0) {
            const double top = Panel::y(share / most);
            drawing.shapes.emplace_back(Bar{corner.x + plot_left + bar * i + 0.3,
                                            corner.y + top,
                                            bar - 0.6,
                                            plot_bottom - top,
                                            ink,
                                            false});
        }
    }
}

void add_panel_axes(Drawing& drawing,
                    const Panel& panel,
                    const Corner& corner,
                    const Localisation& say) {
    const auto at = [&](double x, double y) { return std::pair{corner.x + x, corner.y + y}; };
    drawing.shapes.emplace_back(
        Stroke{StrokeLook::mean, {at(panel.x(0), plot_top - 4), at(panel.x(0), plot_bottom)}});
    drawing.shapes.emplace_back(
        Stroke{StrokeLook::grid, {at(plot_left, plot_bottom), at(plot_right, plot_bottom)}});
    for (const double difference : {-panel.reach, 0.0, panel.reach}) {
        const auto [x, y] = at(panel.x(difference), plot_bottom + 14);
        drawing.shapes.emplace_back(Label{x,
                                          y,
                                          difference < 0   ? Anchor::start
                                          : difference > 0 ? Anchor::end
                                                           : Anchor::middle,
                                          say.shortest(in_unit(difference, say.unit))});
    }
    const auto [x, y] = at(plot_left, 12);
    drawing.shapes.emplace_back(Label{x,
                                      y,
                                      Anchor::start,
                                      fmt::format("{} {}, {}",
                                                  level_text(say, panel.score),
                                                  say.iri_unit(),
                                                  say.count(panel.score.pieces))});
}

void add_panel(Drawing& drawing,
               const Panel& panel,
               const Corner& corner,
               const Localisation& say) {
    double most = *std::ranges::max_element(panel.share);
    if (panel.score.sd > 0) {
        most = std::max(most, curve(panel, panel.score.bias));
    }
    add_bars(drawing, panel, corner, most);
    add_curve(drawing, panel, corner, most);
    add_panel_axes(drawing, panel, corner, say);
}

} // namespace

std::string level_text(const Localisation& say, const SurveyScore& score) {
    const auto border = [&](double mm_per_m) {
        return say.unit == IriUnit::mm_per_m ? say.shortest(mm_per_m) : say.iri(mm_per_m);
    };
    return std::isinf(score.to_mm_per_m)
               ? say("reference.level.last", {{"from", border(score.from_mm_per_m)}})
               : say("reference.level",
                     {{"from", border(score.from_mm_per_m)}, {"to", border(score.to_mm_per_m)}});
}

Drawing scatter_drawing(std::span<const SurveyPair> pairs, const Localisation& say) {
    const auto square = square_of(pairs, say);
    const std::string unit{say.iri_unit()};
    const auto most = say.number(in_unit(square.most, say.unit), 0);
    Drawing drawing{392,
                    396,
                    say("reference.scatter.words",
                        {{"count", say.count(pairs.size())}, {"most", most}, {"unit", unit}}),
                    {}};
    add_axes(drawing, square, say);
    drawing.shapes.emplace_back(dots(pairs, square));
    drawing.shapes.emplace_back(Label{scatter_left + scatter_size / 2,
                                      scatter_top + scatter_size + 36,
                                      Anchor::middle,
                                      say("reference.scatter.across", {{"unit", unit}})});
    drawing.shapes.emplace_back(Label{scatter_left + 6,
                                      scatter_top + 12,
                                      Anchor::start,
                                      say("reference.scatter.up", {{"unit", unit}})});
    return drawing;
}

Drawing differences_drawing(std::span<const SurveyPair> pairs, const Localisation& say) {
    const auto scores = scores_by_band(pairs);
    const auto rows = static_cast<double>((scores.size() + 1) / 2);
    Drawing drawing{2 * panel_width, panel_height * rows, say("reference.differences.words"), {}};
    for (std::size_t i = 0; i < scores.size(); ++i) {
        add_panel(
            drawing,
            panel_of(pairs, scores[i], say),
            {panel_width * static_cast<double>(i % 2), panel_height * static_cast<double>(i / 2)},
            say);
        drawing.words += say("reference.differences.part",
                             {{"level", level_text(say, scores[i])},
                              {"unit", std::string{say.iri_unit()}},
                              {"mean", say.iri_change(scores[i].bias)},
                              {"count", say.count(scores[i].pieces)}});
    }
    return drawing;
}

} // namespace macadam
