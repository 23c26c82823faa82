#include "simulated_drive.hpp"

#include "estimator/simulation/random.hpp"
#include "mapping/simulation/gnss_receiver.hpp"
#include "mapping/simulation/lane.hpp"
#include "mapping/simulation/smoothing.hpp"
#include "mapping/simulation/speed_profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace macadam::bench {
namespace {

enum Draw : std::uint64_t {
    draw_driver = 60,
    draw_path = 61,
    draw_speed = 62,
    draw_gnss = 63,
    draw_latency = 64,
    draw_wheels = 65,
    draw_scale = 66,
    draw_gyro = 67,
    draw_wander = 68
};

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

/// The value at `at` of a line through (from, to), `from` rising; held at the ends.
double interpolated(std::span<const double> from, std::span<const double> to, double at) {
    const auto next = std::ranges::lower_bound(from, at) - from.begin();
    if (next == 0 || next == std::ssize(from)) {
        return next == 0 ? to.front() : to.back();
    }
    const auto i = static_cast<std::size_t>(next);
    return std::lerp(to[i - 1], to[i], (at - from[i - 1]) / (from[i] - from[i - 1]));
}

double end_s(const Motion& motion) {
    return static_cast<double>(motion.travel_m.size() - 1) * motion.step_s;
}

double travel_m_at(const Motion& motion, double t_s) {
    const double steps =
        std::clamp(t_s / motion.step_s, 0.0, static_cast<double>(motion.travel_m.size() - 1));
    const auto i = std::min(static_cast<std::size_t>(steps), motion.travel_m.size() - 2);
    return std::lerp(motion.travel_m[i], motion.travel_m[i + 1], steps - static_cast<double>(i));
}

/// The route's line in the plane of a path.
struct RouteLine {
    std::vector<double> along_m;
    std::vector<PointEn> points;
};

RouteLine line_of_route(const RoadNetwork& roads,
                        const std::vector<EdgeId>& route,
                        const std::vector<double>& start_m,
                        const ExactPlane& plane) {
    RouteLine line;
    for (std::size_t k = 0; k < route.size(); ++k) {
        const auto places = line_of(roads, route[k]);
        double along_m = start_m[k];
        for (std::size_t i = 0; i < places.size(); ++i) {
            along_m += i > 0 ? distance_m(places[i - 1], places[i]) : 0;
            line.along_m.push_back(std::min(along_m, start_m[k + 1]));
            line.points.push_back(plane.to_plane(places[i]));
        }
    }
    return line;
}

/// The place of the line that is nearest to a point, among those not far from where it is known to
/// be.
double nearest_along_m(const RouteLine& line, const PointEn& point, double known_m) {
    constexpr double reach_m = 30;
    auto end = std::ranges::upper_bound(line.along_m, known_m + reach_m);
    end += end == line.along_m.end() ? 0 : 1; // the piece that leads out of reach begins within it
    double best_m = known_m;
    double least = std::numeric_limits<double>::infinity();
    for (auto b = std::ranges::lower_bound(line.along_m, known_m - reach_m); b != end; ++b) {
        if (b == line.along_m.begin()) {
            continue;
        }
        const auto i = static_cast<std::size_t>(b - line.along_m.begin());
        const auto& from = line.points[i - 1];
        const double east_m = line.points[i].east_m - from.east_m;
        const double north_m = line.points[i].north_m - from.north_m;
        const double square = east_m * east_m + north_m * north_m;
        const double share = square > 0 ? std::clamp(((point.east_m - from.east_m) * east_m +
                                                      (point.north_m - from.north_m) * north_m) /
                                                         square,
                                                     0.0,
                                                     1.0)
                                        : 0;
        const double off_m = std::hypot(point.east_m - from.east_m - share * east_m,
                                        point.north_m - from.north_m - share * north_m);
        if (off_m < least) {
            least = off_m;
            best_m = std::lerp(line.along_m[i - 1], line.along_m[i], share);
        }
    }
    return best_m;
}

std::vector<double> abreast_along(const DrivenPath& path, const RouteLine& line) {
    std::vector<double> abreast_m;
    for (std::size_t i = 0; i < path.points.size(); ++i) {
        abreast_m.push_back(nearest_along_m(line, path.points[i], path.route_m[i]));
    }
    return abreast_m;
}

std::vector<double> starts_of(const RoadNetwork& roads, const std::vector<EdgeId>& route) {
    std::vector<double> start_m{0};
    for (const auto edge : route) {
        start_m.push_back(start_m.back() + whole_mm(length_m(roads, edge)));
    }
    return start_m;
}

/// How far the car has turned at each point of its path, left positive. From the path itself: its
/// curvature is held below what cars can steer, which a turn on the spot exceeds.
std::vector<double> turned_along(const DrivenPath& path) {
    std::vector<double> turned_rad(path.points.size(), 0.0);
    double ahead_rad = 0; // of the step that leaves the point; at the point it is half round
    for (std::size_t i = 1; i + 1 < path.points.size(); ++i) {
        const auto in = path.plane.metres(path.points[i - 1], path.points[i]);
        const auto out = path.plane.metres(path.points[i], path.points[i + 1]);
        const double turn_rad = std::atan2(in.east_m * out.north_m - in.north_m * out.east_m,
                                           in.east_m * out.east_m + in.north_m * out.north_m);
        turned_rad[i] = ahead_rad + turn_rad / 2;
        ahead_rad += turn_rad;
    }
    turned_rad.back() = ahead_rad;
    return turned_rad;
}

TriaxialSamples gyro_samples(const Drive& drive, const GyroRecipe& gyro, std::uint64_t seed) {
    const auto turned_rad = turned_along(drive.path);
    const auto turned_at = [&](double t_s) {
        return interpolated(drive.path.travel_m, turned_rad, travel_m_at(drive.motion, t_s));
    };
    const auto count = static_cast<std::size_t>(end_s(drive.motion) * gyro.rate_hz);
    const auto wander = slow_noise(count,
                                   gyro.bias_wander_radps,
                                   gyro.bias_wander_s * gyro.rate_hz,
                                   seed_of({seed, draw_wander}));
    Random random{seed_of({seed, draw_gyro})};
    const double bias_radps[] = {gyro.bias_sd_radps * random.normal(),
                                 gyro.bias_sd_radps * random.normal(),
                                 gyro.bias_sd_radps * random.normal()};
    const double half_s = 0.5 / gyro.rate_hz;
    TriaxialSamples samples;
    for (std::size_t i = 0; i < count; ++i) {
        const double t_s = static_cast<double>(i) / gyro.rate_hz;
        const double yaw_radps = (turned_at(t_s + half_s) - turned_at(t_s - half_s)) / (2 * half_s);
        samples.t_s.push_back(t_s);
        samples.x.push_back(static_cast<float>(bias_radps[0] + gyro.noise_radps * random.normal()));
        samples.y.push_back(static_cast<float>(bias_radps[1] + gyro.noise_radps * random.normal()));
        samples.z.push_back(static_cast<float>(yaw_radps + bias_radps[2] + wander[i] +
                                               gyro.noise_radps * random.normal()));
    }
    return samples;
}

std::vector<GnssFix> without_velocity(std::vector<GnssFix> fixes) {
    for (auto& fix : fixes) {
        fix.speed_mps = unknown;
        fix.course_deg = unknown;
    }
    return fixes;
}

/// How one driver keeps his lane and takes his corners.
DrivingRecipe of_a_driver(DrivingRecipe driving, std::uint64_t seed) {
    Random random{seed};
    driving.lane_offset_m += random.uniform(-1, 1);
    driving.oneway_offset_m += random.uniform(-1.5, 1.5);
    driving.corner_m *= random.uniform(0.6, 1.5);
    return driving;
}

} // namespace

DriveRecipe standard_recipe(double sigma_m, double fix_rate_hz) {
    DriveRecipe recipe;
    recipe.driving.length_km = {7, 11};
    recipe.driving.return_share = 0.3;
    recipe.driving.lane_offset_m = 2.5;
    recipe.driving.wander_m = 0.25;
    recipe.gnss.rate_hz = fix_rate_hz;
    recipe.gnss.sigma_m = sigma_m;
    recipe.gnss.correlation_s = 30;
    recipe.gnss.white_m = 0.1 * sigma_m;
    recipe.gnss.latency_s = {0, 2.5};
    recipe.gnss.outages_per_hour = 0;
    recipe.odometer.rate_hz = 10;
    recipe.odometer.scale_sd = 0.005;
    return recipe;
}

Drive make_drive(const RoadNetwork& roads,
                 const RouteMap& map,
                 const DrivingRecipe& driving,
                 std::uint64_t seed,
                 std::size_t number) {
    auto route = route_of_trip(roads, map, driving, seed, number);
    const auto own = of_a_driver(driving, seed_of({seed, draw_driver, number}));
    auto path = driven_path(roads, route, own, seed_of({seed, draw_path, number}));
    auto motion = drive_along(path, roads, route, own, seed_of({seed, draw_speed, number}));
    auto start_m = starts_of(roads, route);
    auto abreast_m = abreast_along(path, line_of_route(roads, route, start_m, path.plane));
    return {std::move(route),
            std::move(start_m),
            std::move(path),
            std::move(abreast_m),
            std::move(motion)};
}

double route_m_at(const Drive& drive, double t_s) {
    return interpolated(drive.path.travel_m, drive.path.route_m, travel_m_at(drive.motion, t_s));
}

TruePlace true_place_at(const Drive& drive, double t_s) {
    const double travel_m = travel_m_at(drive.motion, t_s);
    const double even_m = interpolated(drive.path.travel_m, drive.path.route_m, travel_m);
    const double abreast_m = interpolated(drive.path.travel_m, drive.abreast_m, travel_m);
    return {std::min(even_m, abreast_m), std::max(even_m, abreast_m)};
}

DrivenPose place_at_time(const Drive& drive, double t_s) {
    return place_at(drive.path, travel_m_at(drive.motion, t_s));
}

double t_s_at(const Drive& drive, double route_m) {
    const double travel_m = interpolated(drive.path.route_m, drive.path.travel_m, route_m);
    const auto& gone_m = drive.motion.travel_m;
    const auto next = std::ranges::lower_bound(gone_m, travel_m) - gone_m.begin();
    if (next == 0 || next == std::ssize(gone_m)) {
        return next == 0 ? 0 : end_s(drive.motion);
    }
    const auto i = static_cast<std::size_t>(next);
    const double share = (travel_m - gone_m[i - 1]) / (gone_m[i] - gone_m[i - 1]);
    return (static_cast<double>(i - 1) + share) * drive.motion.step_s;
}

Recording recorded(const Drive& drive,
                   const DriveRecipe& recipe,
                   const SensorSet& sensors,
                   std::uint64_t seed) {
    const auto drawn = [&](Draw what) { return seed_of({seed, what}); };
    const double latency_s =
        Random{drawn(draw_latency)}.uniform(recipe.gnss.latency_s.low, recipe.gnss.latency_s.high);
    const double scale = 1 + recipe.odometer.scale_sd * Random{drawn(draw_scale)}.normal();

    TripLog trip;
    trip.meta.frame = Frame::flu;
    trip.meta.frame_stated = true;
    trip.meta.gnss_latency_stated = recipe.gnss.latency_stated;
    trip.meta.gnss_latency_s = recipe.gnss.latency_stated ? latency_s : 0;
    trip.fixes = received_fixes(drive.path, drive.motion, recipe.gnss, latency_s, drawn(draw_gnss));
    if (!sensors.course) {
        trip.fixes = without_velocity(std::move(trip.fixes));
    }
    if (sensors.wheel_speed) {
        trip.speed = wheel_speeds(drive.motion, recipe.odometer, scale, drawn(draw_wheels));
    }
    if (sensors.gyro) {
        trip.gyro = gyro_samples(drive, recipe.gyro, drawn(draw_gyro));
    }
    return {std::move(trip), latency_s};
}

} // namespace macadam::bench
