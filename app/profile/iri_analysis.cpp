#include "app/profile/iri_analysis.hpp"

#include "estimator/common/error.hpp"
#include "estimator/iri/localised_roughness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace macadam {
namespace {

std::vector<double>
borders_of(const Course& course, std::optional<double> length_m, const std::string& file) {
    if (!length_m) {
        return {course.from_m, course.to_m};
    }
    const auto& extent = course.extent;
    const double step_m = (extent.last_m - extent.first_m) / static_cast<double>(extent.points - 1);
    if (*length_m < step_m) {
        throw InputError{fmt::format(
            "{}: has a point every {:.3f} m, --length {} is shorter", file, step_m, *length_m)};
    }
    // An interval covered by points is complete, although the envelope shortens the last 250 mm.
    std::vector<double> borders_m{course.from_m};
    while (borders_m.back() + *length_m <= course.covered_to_m + rounding_m) {
        borders_m.push_back(course.from_m + static_cast<double>(borders_m.size()) * *length_m);
    }
    borders_m.back() = std::min(borders_m.back(), course.to_m);
    if (borders_m.size() < 2) {
        throw InputError{fmt::format("{}: {:g} m from {:g} to {:g} are shorter than --length {:g}",
                                     file,
                                     course.to_m - course.from_m,
                                     course.from_m,
                                     course.to_m,
                                     *length_m)};
    }
    return borders_m;
}

/// Weighted means over the intervals between borders.
class Pieces {
public:
    explicit Pieces(std::size_t drives) : sums_(drives), wholes_(drives), means_(drives) {}

    void add(std::span<const double> values, double weight) {
        weight_ += weight;
        for (std::size_t i = 0; i < values.size(); ++i) {
            sums_[i] += weight * values[i];
        }
    }

    void end_piece() {
        for (std::size_t i = 0; i < sums_.size(); ++i) {
            means_[i].push_back(sums_[i] / std::max(weight_, std::numeric_limits<double>::min()));
            wholes_[i] += std::exchange(sums_[i], 0);
        }
        whole_weight_ += std::exchange(weight_, 0);
    }

    IriReport::Channel channel(std::string name, std::size_t drive) {
        return {std::move(name), wholes_[drive] / whole_weight_, std::move(means_[drive])};
    }

private:
    std::vector<double> sums_;
    std::vector<double> wholes_;
    std::vector<std::vector<double>> means_;
    double weight_ = 0;
    double whole_weight_ = 0;
};

Pieces
pieces_of(const IriQuestion& question, const Course& course, const std::vector<double>& borders_m) {
    Pieces pieces{course.extent.tracks.size() + (course.pair() ? 1 : 0)};
    std::vector<std::size_t> ends;
    ends.reserve(borders_m.size());
    for (const double border_m : borders_m) {
        ends.push_back(course.sampled() ? course.index_at(border_m) : ends.size());
    }
    std::size_t index = 0;
    std::size_t piece = 0;
    drive_all(question, course, borders_m, [&](std::span<const double> values) {
        if (index++ < ends.front() || piece + 1 == ends.size()) {
            return;
        }
        pieces.add(values, course.sampled() ? 1 : borders_m[piece + 1] - borders_m[piece]);
        if (index == ends[piece + 1]) {
            pieces.end_piece();
            ++piece;
        }
    });
    return pieces;
}

IriReport::Channel
mean_of(std::string name, const IriReport::Channel& a, const IriReport::Channel& b) {
    IriReport::Channel mean{std::move(name), std::midpoint(a.whole, b.whole), {}};
    mean.pieces.reserve(a.pieces.size());
    for (std::size_t i = 0; i < a.pieces.size(); ++i) {
        mean.pieces.push_back(std::midpoint(a.pieces[i], b.pieces[i]));
    }
    return mean;
}

/// Movement of the base: its step, and the number of steps in the base.
struct Moves {
    double step_m;
    double steps; ///< need not be an integer
};

Moves moves_of(const Course& course, double base_m) {
    constexpr double steps_of_uneven = 30; // 0.254 m of 7.62
    if (!course.sampled()) {
        return {base_m / steps_of_uneven, steps_of_uneven};
    }
    const double step_m = *course.extent.even_step_m;
    return {step_m, std::max(1.0, base_m / step_m)};
}

/// Returns the beginnings of the steps on uneven stations; on even ones these are the points.
std::vector<double> edges_of(const Course& course, const Moves& moves) {
    std::vector<double> edges_m;
    for (std::size_t i = 0;; ++i) {
        const double at_m = course.from_m + static_cast<double>(i) * moves.step_m;
        if (at_m > course.to_m) {
            return edges_m;
        }
        edges_m.push_back(at_m);
    }
}

} // namespace

IriReport iri_of_pieces(const IriQuestion& question, std::optional<double> length_m) {
    const auto course = course_of(question);
    IriReport report{.method = course.method,
                     .borders_m = borders_of(course, length_m, question.profile.string()),
                     .channels = {},
                     .mri = {},
                     .hri = {},
                     .lead_in = {}};
    auto pieces = pieces_of(question, course, report.borders_m);
    const auto& tracks = course.extent.tracks;
    for (std::size_t i = 0; i < tracks.size(); ++i) {
        report.channels.push_back(pieces.channel(tracks[i], i));
    }
    if (const auto pair = course.pair()) {
        report.mri = mean_of("mri", report.channels[pair->left], report.channels[pair->right]);
        report.hri = pieces.channel("hri", tracks.size());
    }
    for (std::size_t i = 0; i + 1 < report.borders_m.size(); ++i) {
        report.lead_in.push_back(course.leads_in(report.borders_m[i]));
    }
    return report;
}

void moving_iri(const IriQuestion& question,
                double base_m,
                const std::function<void(const MovingHead&)>& begin,
                const std::function<void(const MovingIri&)>& take) {
    const auto course = course_of(question);
    const auto& tracks = course.extent.tracks;
    const auto pair = course.pair();
    const auto moves = moves_of(course, base_m);
    const double moved_base_m = moves.steps * moves.step_m;
    if (course.to_m - course.from_m < moved_base_m - rounding_m) {
        throw InputError{
            fmt::format("{}: {:g} m from {:g} to {:g} are shorter than the base, {:g} m",
                        question.profile.string(),
                        course.to_m - course.from_m,
                        course.from_m,
                        course.to_m,
                        moved_base_m)};
    }
    begin({course.method, moved_base_m, tracks, pair.has_value()});

    const auto edges_m = course.sampled() ? std::vector<double>{} : edges_of(course, moves);
    const std::size_t first = course.sampled() ? course.index_at(course.from_m) : 0;
    const std::size_t last =
        course.sampled() ? course.index_at(course.to_m) : std::numeric_limits<std::size_t>::max();
    const double first_m = course.sampled() ? course.start_m : course.from_m;
    std::vector<MovingMean> means(tracks.size(), MovingMean{moves.steps});
    std::vector<double> iri(tracks.size());
    std::size_t index = 0;
    drive_all(question, course, edges_m, [&](std::span<const double> values) {
        const std::size_t at = index++;
        if (at < first || at >= last) {
            return;
        }
        bool full = false;
        for (std::size_t i = 0; i < tracks.size(); ++i) {
            const auto mean = means[i].push(values[i]);
            full = mean.has_value();
            iri[i] = mean.value_or(0);
        }
        if (full) {
            const double end_m = first_m + static_cast<double>(at + 1) * moves.step_m;
            take({.at_m = end_m - moved_base_m / 2,
                  .iri = iri,
                  .mri = pair ? std::optional{std::midpoint(iri[pair->left], iri[pair->right])}
                              : std::nullopt,
                  .lead_in = course.leads_in(end_m - moved_base_m)});
        }
    });
}

} // namespace macadam
