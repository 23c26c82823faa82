#include "estimator/live/live_odometer.hpp"

#include "estimator/common/error.hpp"
#include "estimator/motion/make_odometer.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

void append(Odometer::Knots& knots, double t_s, double travel_m, float speed_mps, std::uint8_t r) {
    knots.t_s.push_back(t_s);
    knots.travel_m.push_back(travel_m);
    knots.speed_mps.push_back(speed_mps);
    knots.reversing.push_back(r);
}

/// Knots [from, to).
Odometer::Knots part_of(const Odometer::Knots& knots, std::ptrdiff_t from, std::ptrdiff_t to) {
    const auto cut = [=](const auto& values) {
        using Values = std::decay_t<decltype(values)>;
        return Values(values.begin() + from, values.begin() + to);
    };
    return {cut(knots.t_s), cut(knots.travel_m), cut(knots.speed_mps), cut(knots.reversing)};
}

/// Appends the new measurements to the settled knots.
Odometer::Knots joined(Odometer::Knots settled, const Odometer& measured) {
    const auto& knots = measured.knots();
    if (settled.t_s.empty()) {
        return knots;
    }
    const double last_s = settled.t_s.back();
    const double off_m = settled.travel_m.back() - measured.travel_m(last_s);
    for (auto i = std::ranges::upper_bound(knots.t_s, last_s) - knots.t_s.begin();
         i < std::ssize(knots.t_s);
         ++i) {
        const auto at = static_cast<std::size_t>(i);
        append(settled,
               knots.t_s[at],
               std::max(knots.travel_m[at] + off_m, settled.travel_m.back()),
               knots.speed_mps[at],
               knots.reversing[at]);
    }
    return settled;
}

/// Extrapolates at the last speed, unless it belongs to the end of a gap and was not measured.
Odometer::Knots going_on(Odometer::Knots knots, double now_s, double longest_s) {
    const std::size_t count = knots.t_s.size();
    const double silence_s = now_s - knots.t_s.back();
    const bool measured = !std::isnan(knots.speed_mps.back()) &&
                          (count < 2 || !std::isnan(knots.speed_mps[count - 2]));
    if (measured && silence_s > 0 && silence_s <= longest_s) {
        const auto speed_mps = static_cast<double>(knots.speed_mps.back());
        append(knots,
               now_s,
               knots.travel_m.back() + speed_mps * silence_s,
               knots.speed_mps.back(),
               knots.reversing.back());
    }
    return knots;
}

/// Returns all but the last knot, which a later speed may change.
Odometer::Knots
settled_of(const Odometer::Knots& knots, double now_s, const LiveRulerConfig& config) {
    const auto before = [&](double t_s) {
        return std::ranges::lower_bound(knots.t_s, t_s) - knots.t_s.begin();
    };
    const auto to = std::min(before(now_s - config.settled_s), std::ssize(knots.t_s) - 1);
    const auto from = std::min(before(now_s - config.keep_s), to);
    return part_of(knots, std::max<std::ptrdiff_t>(0, std::min(from, to - 2)), to);
}

std::optional<Odometer> measured_by(const TripLog& motion, const OdometerConfig& config) {
    try {
        return make_odometer(motion, config).odometer;
    } catch (const InputError&) { // too few data so far
        return std::nullopt;
    }
}

} // namespace

LiveOdometer measured_on(LiveOdometer ruler,
                         const TripLog& motion,
                         double now_s,
                         const LiveRulerConfig& config,
                         bool over) {
    const auto measured = measured_by(motion, config.odometer);
    if (!measured) {
        return ruler;
    }
    auto knots = joined(std::move(ruler.settled), *measured);
    auto settled = settled_of(knots, now_s, config);
    if (!over) {
        const double latency_s =
            std::max({0.0, motion.meta.gnss_latency_s, motion.meta.speed_latency_s});
        knots = going_on(std::move(knots), now_s, config.odometer.max_gap_s + latency_s);
    }
    return {std::move(settled), Odometer{std::move(knots), measured->scale()}};
}

} // namespace macadam
