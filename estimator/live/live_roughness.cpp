#include "estimator/live/live_roughness.hpp"

#include "estimator/motion/mounting.hpp"
#include "estimator/vehicle/vehicle_prior.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace macadam {
namespace {

constexpr double min_length_m = 10;    // of a stretch; its beginning is reported as start-up
constexpr double ended_after_s = 0.5;  // of silence or of unusable data
constexpr double forget_every_m = 100; // limits the moving of data

// A car is tuned on up to a minute of samples (car_in); it is final once that much is available.
constexpr double tuned_every_s = 30;
constexpr double max_tuning_s = 60;

constexpr double infinity = std::numeric_limits<double>::infinity();

double end_m(const IriRun& run) {
    return run.start_travel_m + run.cell_m * static_cast<double>(run.centre_mm_per_m.size());
}

double begin_s(const TripLog& recent, const StretchSpan& span) {
    return recent.acc.t_s[span.first];
}

double end_s(const TripLog& recent, const StretchSpan& span) {
    return recent.acc.t_s[span.last];
}

/// Returns true if the cells of one run can be appended to the other.
bool alike(const IriRun& a, const IriRun& b) {
    return a.left_mm_per_m.empty() == b.left_mm_per_m.empty() &&
           a.scatter_mm_per_m.size() == b.scatter_mm_per_m.size() && a.indicative == b.indicative &&
           a.cell_m == b.cell_m;
}

IriRun empty_like(const IriRun& run, double start_m, double lead_in_m) {
    IriRun empty{.start_travel_m = start_m,
                 .cell_m = run.cell_m,
                 .left_mm_per_m = {},
                 .right_mm_per_m = {},
                 .centre_mm_per_m = {},
                 .speed_mps = {},
                 .lead_in_m = lead_in_m,
                 .indicative = run.indicative,
                 .scatter_mm_per_m = {},
                 .common_sd = run.common_sd,
                 .random_sd = run.random_sd};
    empty.scatter_mm_per_m.resize(run.scatter_mm_per_m.size());
    return empty;
}

/// Appends the value at a position, of values evenly spaced from a run's start.
void push_at(const std::vector<float>& from, double index, std::vector<float>& to) {
    if (!from.empty()) {
        const auto last = static_cast<double>(from.size() - 1);
        to.push_back(from[static_cast<std::size_t>(std::clamp(index, 0.0, last))]);
    }
}

/// Appends one metre of `found`.
void append_metre(const IriRun& found, IriRun& onto) {
    const double from_m = end_m(onto) - found.start_travel_m;
    const auto cells = std::lround(1 / onto.cell_m);
    for (long i = 0; i < cells; ++i) {
        const double cell = (from_m + (static_cast<double>(i) + 0.5) * onto.cell_m) / found.cell_m;
        push_at(found.left_mm_per_m, cell, onto.left_mm_per_m);
        push_at(found.right_mm_per_m, cell, onto.right_mm_per_m);
        push_at(found.centre_mm_per_m, cell, onto.centre_mm_per_m);
        push_at(found.speed_mps, cell, onto.speed_mps);
    }
    for (std::size_t road = 0; road < onto.scatter_mm_per_m.size(); ++road) {
        push_at(found.scatter_mm_per_m[road], from_m + 0.5, onto.scatter_mm_per_m[road]);
    }
}

/// Removes this many metres from the front of a run.
IriRun without_front(IriRun run, std::ptrdiff_t metres) {
    const auto drop = [](std::vector<float>& values, std::ptrdiff_t count) {
        values.erase(values.begin(), values.begin() + std::min(count, std::ssize(values)));
    };
    const auto cells = metres * std::lround(1 / run.cell_m);
    for (auto* values :
         {&run.left_mm_per_m, &run.right_mm_per_m, &run.centre_mm_per_m, &run.speed_mps}) {
        drop(*values, cells);
    }
    for (auto& road : run.scatter_mm_per_m) {
        drop(road, metres);
    }
    run.start_travel_m += static_cast<double>(metres);
    run.lead_in_m = std::max(0.0, run.lead_in_m - static_cast<double>(metres));
    return run;
}

/// Returns the rate of the even grid as make_stretch chooses it for a whole stretch, but from a log
/// rate that is constant over all windows, so that they get the same draws.
double grid_rate_hz(double own_hz, double fastest_mps, const StretchConfig& config) {
    if (config.rate_hz > 0) {
        return config.rate_hz;
    }
    if (config.samples_a_metre > 0) {
        const double enough_hz =
            std::max(config.enough_rate_hz, config.samples_a_metre * fastest_mps);
        return own_hz / std::max(1.0, std::floor(own_hz / enough_hz));
    }
    return std::min(own_hz, config.max_rate_hz);
}

double fastest_mps(const Odometer& odometer, double from_s, double to_s) {
    double fastest = odometer.speed_mps(to_s);
    for (double t_s = from_s; t_s < to_s; t_s += 1) {
        fastest = std::max(fastest, odometer.speed_mps(t_s));
    }
    return fastest;
}

} // namespace

LiveRoughness::LiveRoughness(Vehicle vehicle,
                             StretchConfig stretch,
                             EstimatorConfig estimator,
                             LiveWindow window)
    : vehicle_{std::move(vehicle)}, stretch_{stretch},
      estimator_{estimator}, window_{window}, last_s_{-infinity}, final_s_{-infinity} {
    stretch_.min_length_m = min_length_m;
}

double LiveRoughness::rear_m() const {
    const auto& axles = car_ ? car_->car.vehicle.axles : vehicle_.axles;
    return axles ? axles->cg_to_front_m - axles->wheelbase_m : 0;
}

void LiveRoughness::go_on(const TripLog& recent,
                          const Odometer& odometer,
                          const Mounting& mounting,
                          double now_s,
                          double final_s) {
    add_slow(odometer, final_s);
    known_until_m_ = std::max(known_until_m_, odometer.travel_m(final_s) + rear_m());
    if (recent.acc.t_s.size() < 2) {
        return;
    }
    const auto found = find_stretches(recent, odometer, stretch_, mounting.otherwise);
    for (const auto& span : found.spans) {
        const double span_end_s = end_s(recent, span);
        const bool ended = now_s - span_end_s > ended_after_s;
        const double until_s = ended ? span_end_s : std::min(final_s, span_end_s);
        if (until_s > final_s_) {
            tune(recent, span, odometer, mounting);
            extend(recent, span, odometer, mounting, until_s);
        }
    }
}

void LiveRoughness::tune(const TripLog& recent,
                         const StretchSpan& span,
                         const Odometer& odometer,
                         const Mounting& mounting) {
    const double length_s = end_s(recent, span) - begin_s(recent, span);
    const bool enough = length_s >= std::min(tuned_by_s_ + tuned_every_s, max_tuning_s);
    if (estimator_.method != Method::smoother ||
        (car_ && (!enough || tuned_by_s_ >= max_tuning_s))) {
        return;
    }
    const auto stretch = make_stretch(recent, span, odometer, mounting, stretch_);
    VibrationSpectra spectra;
    if (uses_vertical(estimator_)) {
        add(spectra, stretch);
    }
    const double rate_hz = static_cast<double>(span.last - span.first) / length_s;
    car_ = car_of_trip(spectra, stretch, with_usual_lowpass(vehicle_, rate_hz), estimator_);
    tuned_by_s_ = length_s >= tuned_every_s ? length_s : 0;
}

void LiveRoughness::extend(const TripLog& recent,
                           const StretchSpan& span,
                           const Odometer& odometer,
                           const Mounting& mounting,
                           double final_s) {
    const double last_s = end_s(recent, span);
    const bool goes_on = !trace_.runs.empty() && begin_s(recent, span) <= last_s_;
    const double known_until_m =
        goes_on ? end_m(trace_.runs.back()) : odometer.travel_m(begin_s(recent, span));
    if (!goes_on) {
        rate_hz_ = static_cast<double>(span.last - span.first) / (last_s - begin_s(recent, span));
    }
    const double from_s = std::clamp(odometer.t_s(known_until_m - window_.length_m),
                                     last_s - window_.longest_s,
                                     last_s - window_.min_s);
    const auto& t_s = recent.acc.t_s;
    const auto first =
        static_cast<std::size_t>(std::ranges::lower_bound(t_s, from_s) - t_s.begin());
    const StretchSpan window{std::max(span.first, first), span.last};

    auto config = stretch_;
    config.rate_hz =
        grid_rate_hz(rate_hz_, fastest_mps(odometer, t_s[window.first], last_s), stretch_);
    const auto stretch = make_stretch(recent, window, odometer, mounting, config);
    const auto found = car_ ? smoothed_iri(stretch, car_->car, car_->config)
                            : estimate_iri(stretch, vehicle_, estimator_);
    if (found.centre_mm_per_m.empty()) {
        return;
    }
    if (!goes_on) {
        trace_.runs.push_back(empty_like(found, found.start_travel_m, found.lead_in_m));
        lead_in_until_m_ = found.start_travel_m + found.lead_in_m;
    }
    keep(found, odometer.travel_m(final_s) + rear_m());
    last_s_ = last_s;
    final_s_ = final_s;
}

/// Keeps the whole metres of `found` that are final.
void LiveRoughness::keep(const IriRun& found, double to_m) {
    const double end = end_m(trace_.runs.back());
    if (found.start_travel_m > end + 1) { // a channel was silent for longer than a window
        lead_in_until_m_ = found.start_travel_m + found.lead_in_m;
        trace_.runs.push_back(empty_like(found, found.start_travel_m, found.lead_in_m));
    } else if (!alike(trace_.runs.back(), found)) {
        trace_.runs.push_back(empty_like(found, end, std::max(0.0, lead_in_until_m_ - end)));
    }
    auto& run = trace_.runs.back();
    run.common_sd = found.common_sd;
    run.random_sd = found.random_sd;
    while (end_m(run) + 1 <= std::min(to_m, end_m(found) + found.cell_m)) {
        append_metre(found, run);
    }
}

void LiveRoughness::add_slow(const Odometer& odometer, double until_s) {
    const double until_m = odometer.travel_m(until_s);
    for (auto part : slow_parts(odometer, stretch_.min_speed_mps)) {
        part.from_m = std::max(part.from_m, slow_until_m_);
        part.to_m = std::min(part.to_m, until_m);
        if (part.from_m >= part.to_m) {
            continue;
        }
        if (!trace_.slow.empty() && trace_.slow.back().to_m == part.from_m) {
            trace_.slow.back().to_m = part.to_m;
        } else {
            trace_.slow.push_back(part);
        }
    }
    slow_until_m_ = std::max(slow_until_m_, until_m);
}

void LiveRoughness::forget_before(double travel_m) {
    std::erase_if(trace_.slow, [=](const TravelSpan& part) { return part.to_m <= travel_m; });
    auto& runs = trace_.runs;
    while (runs.size() > 1 && end_m(runs.front()) <= travel_m) {
        runs.erase(runs.begin());
    }
    if (!runs.empty()) {
        const double behind_m = std::floor(travel_m - runs.front().start_travel_m);
        const double whole_m = std::floor(end_m(runs.front()) - runs.front().start_travel_m);
        if (behind_m >= forget_every_m) {
            runs.front() = without_front(std::move(runs.front()),
                                         static_cast<std::ptrdiff_t>(std::min(behind_m, whole_m)));
        }
    }
}

} // namespace macadam
