#include "render/report/comparison/agreement_figure.hpp"

#include "render/scene/nice_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>

namespace macadam {

using namespace document;

namespace {

constexpr std::uint32_t dot_rgb = 0x2c7bb6;      // as in the other figures
constexpr std::uint32_t interval_rgb = 0xd9690c; // orange, readable on light and dark pages

constexpr double plot_left = 46;
constexpr double plot_right = 356;
constexpr double plot_top = 26;
constexpr double plot_bottom = 270;
constexpr double label_height = 13;

/// Frame of the plot in the unit of the pairs.
struct AgreementFrame {
    double from, to;        ///< of the mean
    double lowest, highest; ///< of the difference
    double mean_step, difference_step;

    double x(double mean) const {
        return plot_left + (plot_right - plot_left) * (mean - from) / (to - from);
    }
    double y(double difference) const {
        return plot_bottom - (plot_bottom - plot_top) * (difference - lowest) / (highest - lowest);
    }
};

/// Returns the range of differences shown: all but the farthest half percent, and the limits.
std::pair<double, double> shown_differences(std::span<const AgreementPair> pairs,
                                            const LimitsOfAgreement& limits) {
    constexpr std::size_t tail = 400; // 2 tails of 1/400
    std::vector<double> differences;
    differences.reserve(pairs.size());
    for (const auto& pair : pairs) {
        differences.push_back(pair.a - pair.b);
    }
    std::ranges::sort(differences);
    const auto cut = differences.size() / tail;
    double low = std::min(0.0, differences[cut]);
    double high = std::max(0.0, differences[differences.size() - 1 - cut]);
    for (const double bound :
         {limits.lower.low, limits.lower.value, limits.upper.value, limits.upper.high}) {
        if (std::isfinite(bound)) {
            low = std::min(low, bound);
            high = std::max(high, bound);
        }
    }
    return {low, high};
}

AgreementFrame frame_of(std::span<const AgreementPair> pairs, const LimitsOfAgreement& limits) {
    constexpr double min_reach = 0.05; // mm/m or in/mi
    double from = (pairs.front().a + pairs.front().b) / 2, to = from;
    for (const auto& pair : pairs) {
        from = std::min(from, (pair.a + pair.b) / 2);
        to = std::max(to, (pair.a + pair.b) / 2);
    }
    auto [low, high] = shown_differences(pairs, limits);
    const double step = nice_step(std::max(high - low, min_reach), 6);
    const double mean_step = nice_step(std::max(to - from, min_reach), 6);
    AgreementFrame frame{std::max(0.0, mean_step * std::floor(from / mean_step)),
                         mean_step * std::ceil(to / mean_step),
                         step * std::floor(low / step),
                         step * std::ceil(high / step),
                         mean_step,
                         step};
    if (!(frame.to > frame.from)) {
        frame.to = frame.from + mean_step;
    }
    if (!(frame.highest > frame.lowest)) {
        frame.lowest -= step;
        frame.highest += step;
    }
    return frame;
}

/// Returns the number with a minus sign instead of a hyphen.
std::string axis_text(double value, const Localisation& say) {
    return (value < 0 ? "−" : "") + say.shortest(std::abs(value));
}

void add_axes(Drawing& drawing, const AgreementFrame& frame, const Localisation& say) {
    const auto count = std::lround((frame.highest - frame.lowest) / frame.difference_step);
    for (long i = 0; i <= count; ++i) {
        const double difference = frame.lowest + static_cast<double>(i) * frame.difference_step;
        const double y = frame.y(difference);
        const bool is_zero = std::abs(difference) < frame.difference_step / 2;
        drawing.shapes.emplace_back(Stroke{StrokeLook::grid, {{plot_left, y}, {plot_right, y}}});
        drawing.shapes.emplace_back(
            Label{plot_left - 6, y + 4, Anchor::end, is_zero ? "0" : axis_text(difference, say)});
    }
    const auto columns = std::lround((frame.to - frame.from) / frame.mean_step);
    for (long i = 0; i <= columns; ++i) {
        const double mean = frame.from + static_cast<double>(i) * frame.mean_step;
        drawing.shapes.emplace_back(
            Label{frame.x(mean), plot_bottom + 16, Anchor::middle, say.shortest(mean)});
    }
    drawing.shapes.emplace_back(
        Label{6, 12, Anchor::start, fmt::format("Difference A − B, {}", say.iri_unit())});
    drawing.shapes.emplace_back(Label{(plot_left + plot_right) / 2,
                                      plot_bottom + 36,
                                      Anchor::middle,
                                      fmt::format("Mean of A and B, {}", say.iri_unit())});
}

/// Adds the dots on a grid of half a unit, without duplicates. \returns the number outside.
std::size_t
add_dots(Drawing& drawing, std::span<const AgreementPair> pairs, const AgreementFrame& frame) {
    std::set<std::pair<long, long>> places;
    std::size_t outside = 0;
    for (const auto& pair : pairs) {
        const double difference = pair.a - pair.b;
        if (difference < frame.lowest || difference > frame.highest) {
            ++outside;
            continue;
        }
        places.emplace(std::lround(2 * frame.x((pair.a + pair.b) / 2)),
                       std::lround(2 * frame.y(difference)));
    }
    Dots dots{{}, 4, dot_rgb};
    for (const auto& [x, y] : places) {
        dots.places.emplace_back(static_cast<double>(x) / 2, static_cast<double>(y) / 2);
    }
    drawing.shapes.emplace_back(std::move(dots));
    return outside;
}

/// Adds the lines of bias and limits, with a bar for each interval and its value beside it.
void add_limits(Drawing& drawing,
                const LimitsOfAgreement& limits,
                const AgreementFrame& frame,
                const Localisation& say) {
    constexpr double bar_width = 4;
    const std::array<std::pair<const Estimate*, const char*>, 3> lines{
        {{&limits.upper, "upper limit"}, {&limits.bias, "bias"}, {&limits.lower, "lower limit"}}};
    double last_label = plot_top - label_height;
    for (const auto& [line, name] : lines) {
        if (!std::isfinite(line->value)) {
            continue;
        }
        const double y = frame.y(line->value);
        drawing.shapes.emplace_back(Stroke{StrokeLook::mean, {{plot_left, y}, {plot_right, y}}});
        if (std::isfinite(line->low)) {
            const double top = frame.y(line->high);
            drawing.shapes.emplace_back(Bar{plot_right + 3,
                                            top,
                                            bar_width,
                                            std::max(1.0, frame.y(line->low) - top),
                                            interval_rgb,
                                            false});
        }
        last_label = std::max(y + 4, last_label + label_height);
        drawing.shapes.emplace_back(
            Label{plot_right + 12,
                  last_label,
                  Anchor::start,
                  fmt::format("{} {}", say.signed_number(line->value, 2), name)});
    }
}

} // namespace

AgreementFigure agreement_figure(std::span<const AgreementPair> pairs,
                                 const MethodAgreement& agreement,
                                 const Localisation& say) {
    const auto& limits = agreement.difference;
    const auto frame = frame_of(pairs, limits);
    AgreementFigure figure{{480,
                            plot_bottom + 44,
                            fmt::format("Bland–Altman plot of {} pairs: bias {} {}",
                                        say.count(pairs.size()),
                                        say.signed_number(limits.bias.value, 2),
                                        say.iri_unit()),
                            {}},
                           0};
    if (std::isfinite(limits.sd)) {
        figure.drawing.words += fmt::format(", limits of agreement {} and {} {}",
                                            say.signed_number(limits.lower.value, 2),
                                            say.signed_number(limits.upper.value, 2),
                                            say.iri_unit());
    }
    add_axes(figure.drawing, frame, say);
    figure.outside = add_dots(figure.drawing, pairs, frame);
    add_limits(figure.drawing, limits, frame, say);
    return figure;
}

} // namespace macadam
