#include "estimator/events/event_templates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace macadam {
namespace {

constexpr double dip_lengths_m[] = {0.5, 0.75, 1, 1.5};
constexpr double raise_lengths_m[] = {0.5, 0.75, 1, 1.5, 2, 3, 4};
constexpr double step_blur_m = 0.75; // over which the smoother draws out a step

/// Height of the whole wave of a cosine from 0 to 1, highest in the middle.
double wave(double part) {
    return part <= 0 || part >= 1 ? 0 : 0.5 - 0.5 * std::cos(2 * std::numbers::pi * part);
}

/// Mean of the wave over one step around a station.
double mean_wave(double at_m, double length_m, double step_m) {
    constexpr int points = 10;
    double sum = 0;
    for (int i = 0; i < points; ++i) {
        sum += wave((at_m + step_m * ((i + 0.5) / points - 0.5)) / length_m);
    }
    return sum / points;
}

/// Builds a dip or raise that is symmetric about a station or, with an even number of changes
/// between, about the middle of two.
EventTemplate wave_template(EventShape shape, double length_m, double step_m, double shift) {
    const double sign = shape == EventShape::dip ? -1 : 1;
    const auto reach = static_cast<int>(std::ceil(length_m / 2 / step_m)) + 1;
    EventTemplate built{.shape = shape, .length_m = length_m, .change = {}};
    double before = 0;
    for (int i = -reach; i <= reach + 1; ++i) {
        const double at_m = (i - shift) * step_m + length_m / 2;
        const double height = sign * mean_wave(at_m, length_m, step_m);
        built.change.push_back(height - before);
        before = height;
    }
    const auto empty = [](double change) { return change == 0; };
    auto& change = built.change;
    change.erase(change.begin(), std::ranges::find_if_not(change, empty));
    while (empty(change.back())) {
        change.pop_back();
    }
    return built;
}

EventTemplate step_template(double step_m) {
    const auto count = std::max(1, static_cast<int>(std::lround(step_blur_m / step_m)));
    EventTemplate built{.shape = EventShape::step, .length_m = 0, .change = {}};
    double sum = 0;
    for (int i = 0; i < count; ++i) {
        built.change.push_back(wave((i + 1.0) / (count + 1)));
        sum += built.change.back();
    }
    std::ranges::for_each(built.change, [=](double& change) { change /= sum; });
    return built;
}

/// Least-squares size of changes [from, to) of a template that begins at a station.
double size_of(const EventTemplate& shape,
               std::span<const float> profile_m,
               std::size_t at,
               std::size_t from,
               std::size_t to) {
    double product = 0;
    double square = 0;
    for (std::size_t k = from; k < to; ++k) {
        const double change =
            static_cast<double>(profile_m[at + k + 1]) - static_cast<double>(profile_m[at + k]);
        product += shape.change[k] * change;
        square += shape.change[k] * shape.change[k];
    }
    return product / square;
}

} // namespace

std::vector<EventTemplate> event_templates(double step_m) {
    std::vector<EventTemplate> templates;
    for (const double shift : {0.0, 0.5}) {
        for (const double length_m : dip_lengths_m) {
            templates.push_back(wave_template(EventShape::dip, length_m, step_m, shift));
        }
        for (const double length_m : raise_lengths_m) {
            templates.push_back(wave_template(EventShape::raise, length_m, step_m, shift));
        }
    }
    templates.push_back(step_template(step_m));
    return templates;
}

std::vector<double> template_sizes(const EventTemplate& shape, std::span<const float> profile_m) {
    std::vector<double> sizes(profile_m.size());
    for (std::size_t at = 0; at + shape.change.size() < profile_m.size(); ++at) {
        sizes[at] = size_of(shape, profile_m, at, 0, shape.change.size());
    }
    return sizes;
}

double smaller_half(const EventTemplate& shape, std::span<const float> profile_m, std::size_t at) {
    const std::size_t count = shape.change.size();
    return std::min(size_of(shape, profile_m, at, 0, count / 2),
                    size_of(shape, profile_m, at, count - count / 2, count));
}

} // namespace macadam
