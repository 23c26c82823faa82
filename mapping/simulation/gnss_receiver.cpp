#include "mapping/simulation/gnss_receiver.hpp"

#include "estimator/simulation/random.hpp"
#include "mapping/simulation/smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace macadam {
namespace {

enum Draw : std::uint64_t {
    draw_east = 31,
    draw_north = 32,
    draw_white = 33,
    draw_outages = 34,
    draw_start = 35,
    draw_wheels = 36
};

double duration_s(const Motion& motion) {
    return static_cast<double>(motion.travel_m.size() - 1) * motion.step_s;
}

/// Interpolates a value of the motion between two steps, clamped at the ends.
double at_time(const Motion& motion, const std::vector<double>& values, double t_s) {
    const double steps =
        std::clamp(t_s / motion.step_s, 0.0, static_cast<double>(values.size() - 1));
    const auto i = std::min(static_cast<std::size_t>(steps), values.size() - 2);
    return values[i] + (steps - static_cast<double>(i)) * (values[i + 1] - values[i]);
}

/// Time without a fix.
struct Outage {
    double from_s;
    double to_s;
};

/// Draws the times without a fix. The wait for the next outage is drawn second by second.
std::vector<Outage> outages_of(const GnssRecipe& gnss, double whole_s, std::uint64_t seed) {
    Random random{seed_of({seed, draw_outages})};
    std::vector<Outage> outages{{0, random.uniform(gnss.first_fix_s.low, gnss.first_fix_s.high)}};
    for (double t_s = outages.back().to_s; t_s < whole_s; t_s += 1) {
        if (random.uniform() < gnss.outages_per_hour / 3600) {
            outages.push_back({t_s, t_s + random.uniform(gnss.outage_s.low, gnss.outage_s.high)});
            t_s = outages.back().to_s;
        }
    }
    return outages;
}

bool is_in(const std::vector<Outage>& outages, double t_s) {
    return std::ranges::any_of(
        outages, [&](const Outage& outage) { return outage.from_s <= t_s && t_s < outage.to_s; });
}

PointEn left_of(const PointEn& heading) {
    return {-heading.north_m, heading.east_m};
}

/// Position error of each fix: a slow part and a white part.
struct PositionError {
    std::vector<double> east_m;
    std::vector<double> north_m;
};

PositionError position_error(std::size_t count, const GnssRecipe& gnss, std::uint64_t seed) {
    const double steps = gnss.correlation_s * gnss.rate_hz;
    PositionError error{slow_noise(count, gnss.sigma_m, steps, seed_of({seed, draw_east})),
                        slow_noise(count, gnss.sigma_m, steps, seed_of({seed, draw_north}))};
    Random random{seed_of({seed, draw_white, 0})};
    for (std::size_t i = 0; i < count; ++i) {
        error.east_m[i] += gnss.white_m * random.normal();
        error.north_m[i] += gnss.white_m * random.normal();
    }
    return error;
}

/// Returns the course, clockwise from north.
double course_of_deg(const PointEn& velocity) {
    const double degrees = std::atan2(velocity.east_m, velocity.north_m) * 180 / std::numbers::pi;
    return degrees < 0 ? degrees + 360 : degrees;
}

} // namespace

std::vector<GnssFix> received_fixes(const DrivenPath& path,
                                    const Motion& motion,
                                    const GnssRecipe& gnss,
                                    double latency_s,
                                    std::uint64_t seed) {
    const double whole_s = duration_s(motion);
    const auto outages = outages_of(gnss, whole_s, seed);
    const double first_s = Random{seed_of({seed, draw_start})}.uniform() / gnss.rate_hz;
    const auto count = static_cast<std::size_t>(std::max(0.0, (whole_s - first_s) * gnss.rate_hz));
    const auto error = position_error(count, gnss, seed);
    const double accuracy_m = std::sqrt(gnss.sigma_m * gnss.sigma_m + gnss.white_m * gnss.white_m);

    Random random{seed_of({seed, draw_white, 1})};
    std::vector<GnssFix> fixes;
    for (std::size_t i = 0; i < count; ++i) {
        const double t_s = first_s + static_cast<double>(i) / gnss.rate_hz;
        const double along_error = gnss.speed_sd_mps * random.normal();
        const double across_error = gnss.speed_sd_mps * random.normal();
        if (is_in(outages, t_s)) {
            continue;
        }
        const auto [at, heading] =
            place_at(path, at_time(motion, motion.travel_m, t_s - latency_s));
        const auto left = left_of(heading);
        const PointEn antenna{at.east_m + gnss.antenna_ahead_m * heading.east_m +
                                  gnss.antenna_left_m * left.east_m,
                              at.north_m + gnss.antenna_ahead_m * heading.north_m +
                                  gnss.antenna_left_m * left.north_m};
        const double speed = at_time(motion, motion.speed_mps, t_s - latency_s) + along_error;
        const PointEn velocity{speed * heading.east_m + across_error * left.east_m,
                               speed * heading.north_m + across_error * left.north_m};
        fixes.push_back(
            {.t_s = t_s,
             .at = path.plane.to_geo(
                 {antenna.east_m + error.east_m[i], antenna.north_m + error.north_m[i]}),
             .speed_mps = static_cast<float>(std::sqrt(velocity.east_m * velocity.east_m +
                                                       velocity.north_m * velocity.north_m)),
             .course_deg = static_cast<float>(course_of_deg(velocity)),
             .accuracy_m = static_cast<float>(accuracy_m)});
    }
    return fixes;
}

SpeedSamples wheel_speeds(const Motion& motion,
                          const OdometerRecipe& odometer,
                          double scale,
                          std::uint64_t seed) {
    Random random{seed_of({seed, draw_wheels})};
    const double first_s = random.uniform() / odometer.rate_hz;
    SpeedSamples samples;
    for (std::size_t i = 0;; ++i) {
        const double t_s = first_s + static_cast<double>(i) / odometer.rate_hz;
        if (t_s > duration_s(motion)) {
            return samples;
        }
        const double speed = at_time(motion, motion.speed_mps, t_s);
        const double noise = speed > 0 ? odometer.noise_mps * random.normal() : 0;
        double shown = std::max(0.0, speed * scale + noise);
        if (odometer.quantum_mps > 0) {
            shown = std::round(shown / odometer.quantum_mps) * odometer.quantum_mps;
        }
        samples.t_s.push_back(t_s);
        samples.speed_mps.push_back(static_cast<float>(shown));
    }
}

} // namespace macadam
