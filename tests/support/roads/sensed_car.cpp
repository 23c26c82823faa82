#include "sensed_car.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace macadam::testing {
namespace {

constexpr double step_s = 0.1;
constexpr double brake_mps2 = 2;
constexpr double corner_mps = 4;
constexpr double corner_deg = 50;
constexpr double corner_m = 5; // before and behind a vertex the car turns evenly
constexpr double crawl_mps = 0.3;
constexpr double fading_s = 30;
constexpr double white_share = 0.2;
constexpr double odometer_scale = 1.005;
constexpr double gyro_bias_radps = 0.002;
constexpr double rad_per_deg = std::numbers::pi / 180;
constexpr double m_per_deg = 111150; // of latitude, about

/// A vertex of the line: where along it, and by how much the course turns there, clockwise.
struct Corner {
    double at_m;
    double turn_deg;
};

struct Track {
    std::vector<GeoPoint> line;
    std::vector<double> at_m;
    std::vector<double> course_deg; ///< of each step of the line

    explicit Track(const std::vector<GeoPoint>& places) : line{places}, at_m{0} {
        for (std::size_t i = 1; i < line.size(); ++i) {
            at_m.push_back(at_m.back() + distance_m(line[i - 1], line[i]));
            course_deg.push_back(macadam::course_deg(line[i - 1], line[i]));
        }
    }
    std::size_t step(double m) const {
        const auto after = std::upper_bound(at_m.begin() + 1, at_m.end() - 1, m);
        return static_cast<std::size_t>(after - at_m.begin()) - 1;
    }
    GeoPoint place(double m) const {
        const auto i = step(m);
        return between(line[i], line[i + 1], (m - at_m[i]) / (at_m[i + 1] - at_m[i]));
    }
    std::vector<Corner> corners() const {
        std::vector<Corner> all;
        for (std::size_t i = 1; i < course_deg.size(); ++i) {
            const double turn_deg = std::remainder(course_deg[i] - course_deg[i - 1], 360);
            all.push_back({at_m[i], turn_deg > 179 ? -180 : turn_deg}); // cars turn round leftward
        }
        return all;
    }
};

double speed_at(double gone_m, const CarConfig& config, const std::vector<Corner>& corners) {
    double speed_mps = config.cruise_mps;
    const auto limit = [&](double at_m, double limit_mps) {
        speed_mps = std::min(
            speed_mps, std::sqrt(limit_mps * limit_mps + 2 * brake_mps2 * std::abs(gone_m - at_m)));
    };
    for (const auto& corner : corners) {
        if (std::abs(corner.turn_deg) > corner_deg) {
            limit(corner.at_m, corner_mps);
        }
    }
    for (const auto& stop : config.stops) {
        limit(stop.at_m, 0);
    }
    return std::max(speed_mps, crawl_mps);
}

/// Where along the line the car was at each step of time.
std::vector<double> way_of(const Track& track, const CarConfig& config) {
    const auto corners = track.corners();
    std::vector<double> gone_m{0};
    auto stop = config.stops.begin();
    while (gone_m.back() < track.at_m.back()) {
        const double now_m = gone_m.back();
        if (stop != config.stops.end() && now_m >= stop->at_m) {
            gone_m.insert(gone_m.end(), static_cast<std::size_t>(stop->for_s / step_s), now_m);
            ++stop;
        }
        gone_m.push_back(now_m + step_s * speed_at(now_m, config, corners));
    }
    gone_m.back() = track.at_m.back();
    return gone_m;
}

/// Turned since the start, radians clockwise: each corner evenly within a few metres.
double turned_rad(double gone_m, const std::vector<Corner>& corners) {
    double turned_deg = 0;
    for (const auto& corner : corners) {
        turned_deg += corner.turn_deg *
                      std::clamp((gone_m - corner.at_m + corner_m) / (2 * corner_m), 0.0, 1.0);
    }
    return turned_deg * rad_per_deg;
}

bool is_silent(double gone_m, const CarConfig& config) {
    return std::any_of(config.silences.begin(), config.silences.end(), [&](const Silence& silence) {
        return silence.from_m < gone_m && gone_m < silence.to_m;
    });
}

std::vector<GnssFix>
fixes_of(const Track& track, const std::vector<double>& gone_m, const CarConfig& config) {
    constexpr auto unknown = std::numeric_limits<float>::quiet_NaN();
    constexpr int steps_between = 10;
    const double keep = std::exp(-step_s * steps_between / fading_s);
    std::mt19937_64 random{config.seed};
    std::normal_distribution<double> normal{0, 1};
    double slow[2] = {normal(random), normal(random)};
    std::vector<GnssFix> fixes;
    for (std::size_t k = 0; k < gone_m.size(); k += steps_between) {
        const auto at = track.place(gone_m[k]);
        const double right_rad = (track.course_deg[track.step(gone_m[k])] + 90) * rad_per_deg;
        double moved_m[2] = {config.lane_m * std::sin(right_rad),
                             config.lane_m * std::cos(right_rad)};
        for (int axis = 0; axis < 2; ++axis) {
            slow[axis] = keep * slow[axis] + std::sqrt(1 - keep * keep) * normal(random);
            moved_m[axis] +=
                config.noise_m * (std::sqrt(1 - white_share * white_share) * slow[axis] +
                                  white_share * normal(random));
        }
        if (!is_silent(gone_m[k], config)) {
            const double m_per_deg_lon = m_per_deg * std::cos(at.lat_deg * rad_per_deg);
            fixes.push_back(
                {static_cast<double>(k) * step_s,
                 {at.lat_deg + moved_m[1] / m_per_deg, at.lon_deg + moved_m[0] / m_per_deg_lon},
                 unknown,
                 unknown,
                 unknown});
        }
    }
    return fixes;
}

} // namespace

std::string name_of(Sensors sensors) {
    switch (sensors) {
    case Sensors::positions:
        return "positions";
    case Sensors::odometer:
        return "positions, odometer";
    case Sensors::gyro:
        break;
    }
    return "positions, odometer, gyro";
}

TripLog sensed(const std::vector<GeoPoint>& line, Sensors sensors, const CarConfig& config) {
    const Track track{line};
    const auto gone_m = way_of(track, config);
    const auto corners = track.corners();
    TripLog trip;
    trip.fixes = fixes_of(track, gone_m, config);
    for (std::size_t k = 0; k + 1 < gone_m.size(); ++k) {
        const double t_s = static_cast<double>(k) * step_s;
        if (sensors >= Sensors::odometer) {
            const double speed_mps = (gone_m[k + 1] - gone_m[k]) / step_s;
            trip.speed.t_s.push_back(t_s);
            trip.speed.speed_mps.push_back(static_cast<float>(speed_mps * odometer_scale));
        }
        if (sensors >= Sensors::gyro) { // left is positive
            const double yaw_radps =
                (turned_rad(gone_m[k], corners) - turned_rad(gone_m[k + 1], corners)) / step_s;
            trip.gyro.t_s.push_back(t_s);
            trip.gyro.x.push_back(0);
            trip.gyro.y.push_back(0);
            trip.gyro.z.push_back(static_cast<float>(yaw_radps + gyro_bias_radps));
        }
    }
    return trip;
}

} // namespace macadam::testing
