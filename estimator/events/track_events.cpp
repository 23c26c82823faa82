#include "estimator/events/track_events.hpp"

#include "estimator/common/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace macadam {
namespace {

constexpr double mm_per_m = 1000;

constexpr double road_window_m = 25;     // on both sides, for the road's own responses
constexpr double error_window_m = 3;     // on both sides, for those of the error
constexpr double normal_median = 0.6745; // median magnitude of a standard normal number

constexpr double start_up_m = 20; // at both ends the estimate settles

// Both edges of a hole are steep. The half that is less so has at least this part of the size; the
// edge of a long depression has one half only.
constexpr double min_half = 0.4;

// A step lasts: the levels over a metre before and behind it differ by this part of its size.
constexpr double lasting_m = 1.5;
constexpr double lasting_blur_m = 0.5;
constexpr double min_lasting = 0.6;

constexpr double apart_m = 1; // of events in one track

// Error of a size relative to it, from simulated cars (docs/method/events.md): dampers and tyres
// are not linear at a hole, and a short hole is known by its area rather than by its depth.
constexpr double size_part = 0.3;

// A car that a hole shakes differs from its linear model for as long as it sways: smaller events
// within a wheelbase or so of a large one are not told from that.
constexpr double echo_m = 5;
constexpr double echo_part = 0.5;

/// Standard deviation of the road's own responses, robust against events; found, metre by metre,
/// where it is asked for.
class RoadScatter {
public:
    RoadScatter(const std::vector<double>& sizes, double step_m)
        : sizes_{sizes}, reach_{static_cast<std::size_t>(road_window_m / step_m)},
          every_{std::max<std::size_t>(1, static_cast<std::size_t>(1 / step_m))} {}

    double sd_at(std::size_t station) {
        if (station < begin_ || station >= end_) {
            begin_ = station / every_ * every_;
            end_ = begin_ + every_;
            const std::size_t from = begin_ - std::min(begin_, reach_);
            const std::size_t to = std::min(sizes_.size(), begin_ + reach_ + 1);
            near_.clear();
            for (std::size_t i = from; i < to; ++i) {
                near_.push_back(std::abs(sizes_[i]));
            }
            sd_ = median(near_) / normal_median;
        }
        return sd_;
    }

private:
    const std::vector<double>& sizes_;
    std::size_t reach_;     ///< stations
    std::size_t every_;     ///< stations per metre
    std::size_t begin_ = 0; ///< of the metre whose scatter is known
    std::size_t end_ = 0;   ///< none is known yet
    double sd_ = 0;         ///< of that metre
    std::vector<double> near_{};
};

/// Returns per station the root mean square of the responses to the error nearby.
std::vector<double> error_sd(const std::vector<double>& sizes, double step_m) {
    const auto reach = static_cast<std::size_t>(error_window_m / step_m);
    std::vector<double> sums(sizes.size() + 1);
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        sums[i + 1] = sums[i] + sizes[i] * sizes[i];
    }
    std::vector<double> sd(sizes.size());
    for (std::size_t at = 0; at < sizes.size(); ++at) {
        const std::size_t from = at - std::min(at, reach);
        const std::size_t to = std::min(sizes.size(), at + reach + 1);
        sd[at] = std::sqrt((sums[to] - sums[from]) / static_cast<double>(to - from));
    }
    return sd;
}

double mean_of(std::span<const float> values) {
    double sum = 0;
    for (const float value : values) {
        sum += static_cast<double>(value);
    }
    return sum / static_cast<double>(values.size());
}

/// Returns whether the level behind a step differs from that before it as the step says.
bool lasts(std::span<const float> profile_m, std::size_t middle, double size_m, double step_m) {
    const auto blur = static_cast<std::size_t>(lasting_blur_m / step_m);
    const auto reach = static_cast<std::size_t>(lasting_m / step_m);
    if (middle < reach || middle + reach >= profile_m.size()) {
        return false;
    }
    const double before = mean_of(profile_m.subspan(middle - reach, reach - blur));
    const double behind = mean_of(profile_m.subspan(middle + blur + 1, reach - blur));
    return (behind - before) / size_m >= min_lasting;
}

bool has_its_form(const EventTemplate& shape,
                  std::span<const float> profile_m,
                  std::size_t at,
                  double size_m,
                  double step_m) {
    if (shape.shape == EventShape::step) {
        return lasts(profile_m, at + (shape.change.size() + 1) / 2, size_m, step_m);
    }
    return smaller_half(shape, profile_m, at) >= min_half * size_m;
}

/// Appends all stations at which a template responds clearly.
void add_responses(const EventTemplate& shape,
                   std::span<const float> profile_m,
                   std::span<const float> error_m,
                   double step_m,
                   const EventConfig& config,
                   std::vector<TrackEvent>& events) {
    const auto sizes = template_sizes(shape, profile_m);
    RoadScatter road{sizes, step_m};
    const auto error = error_sd(template_sizes(shape, error_m), step_m);
    const bool is_step = shape.shape == EventShape::step;
    const double min_m = (is_step ? config.min_line_mm : config.min_hole_mm) / mm_per_m;
    const double half_m = step_m * static_cast<double>(shape.change.size()) / 2;
    const double whole_m = step_m * static_cast<double>(profile_m.size());
    for (std::size_t at = 0; at < sizes.size(); ++at) {
        const double size_m = is_step ? std::abs(sizes[at]) : sizes[at];
        const double at_m = step_m * static_cast<double>(at) + half_m;
        if (!(size_m >= min_m && size_m > config.min_score * error[at] && at_m > start_up_m &&
              at_m < whole_m - start_up_m)) {
            continue;
        }
        const double sd_m = std::hypot(road.sd_at(at), error[at]);
        if (size_m > config.min_score * sd_m &&
            has_its_form(shape, profile_m, at, sizes[at], step_m)) {
            events.push_back({.shape = shape.shape,
                              .at_m = at_m,
                              .length_m = shape.length_m,
                              .size_mm = mm_per_m * sizes[at],
                              .sd_mm = mm_per_m * std::hypot(sd_m, size_part * size_m),
                              .score = size_m / sd_m});
        }
    }
}

/// Returns whether a stronger event explains another nearby.
bool explains(const TrackEvent& stronger, const TrackEvent& other) {
    const double apart = std::abs(stronger.at_m - other.at_m);
    return apart < std::max(apart_m, (stronger.length_m + other.length_m) / 2) ||
           (apart < echo_m && std::abs(other.size_mm) < echo_part * std::abs(stronger.size_mm));
}

// An event explains others within this distance only: two raises of 4 m overlap up to 4 m apart.
constexpr double explains_m = echo_m;
static_assert(explains_m >= 4 && explains_m >= apart_m);

/// Keeps the events that no stronger one explains.
///
/// \param all  the strongest first.
/// \returns    in order along the track
std::vector<TrackEvent> unexplained(const std::vector<TrackEvent>& all) {
    std::multimap<double, TrackEvent> kept; // by place
    for (const auto& event : all) {
        const auto first = kept.lower_bound(event.at_m - explains_m);
        const auto past = kept.upper_bound(event.at_m + explains_m);
        if (std::none_of(
                first, past, [&](const auto& other) { return explains(other.second, event); })) {
            kept.emplace(event.at_m, event);
        }
    }
    std::vector<TrackEvent> events;
    events.reserve(kept.size());
    for (const auto& [at_m, event] : kept) {
        events.push_back(event);
    }
    return events;
}

} // namespace

std::vector<TrackEvent> events_in_track(std::span<const float> profile_m,
                                        std::span<const float> error_m,
                                        double step_m,
                                        const EventConfig& config) {
    std::vector<TrackEvent> all;
    if (profile_m.empty() || error_m.size() != profile_m.size()) {
        return all;
    }
    for (const auto& shape : event_templates(step_m)) {
        add_responses(shape, profile_m, error_m, step_m, config, all);
    }
    std::ranges::sort(all, [](const TrackEvent& a, const TrackEvent& b) {
        return std::tuple{-a.score, a.at_m, a.length_m} < std::tuple{-b.score, b.at_m, b.length_m};
    });
    return unexplained(all);
}

} // namespace macadam
