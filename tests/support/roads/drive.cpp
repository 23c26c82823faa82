#include "drive.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

namespace macadam::testing {
namespace {

constexpr double fine_step_s = 0.001;
constexpr double gravity_mps2 = 9.81;
constexpr double metres_per_degree =
    111195; // on a sphere: the roads of these tests are drawn with it

using State = std::array<double, 4>; // sprung height, its rate, unsprung height, its rate

State rate_of(const State& x, double road_m, const HalfCar& car) {
    const double suspension_n = car.ks_n_per_m * (x[2] - x[0]) + car.cs_ns_per_m * (x[3] - x[1]);
    return {x[1],
            suspension_n / (car.ms_kg / 4),
            x[3],
            (car.kt_n_per_m * (road_m - x[2]) - suspension_n) / car.mu_kg};
}

State plus(const State& x, double step, const State& rate) {
    State sum{};
    for (std::size_t i = 0; i < x.size(); ++i) {
        sum[i] = x[i] + step * rate[i];
    }
    return sum;
}

State stepped(const State& x, const std::array<double, 3>& road_m, const HalfCar& car) {
    const auto k1 = rate_of(x, road_m[0], car);
    const auto k2 = rate_of(plus(x, fine_step_s / 2, k1), road_m[1], car);
    const auto k3 = rate_of(plus(x, fine_step_s / 2, k2), road_m[1], car);
    const auto k4 = rate_of(plus(x, fine_step_s, k3), road_m[2], car);
    State sum{};
    for (std::size_t i = 0; i < x.size(); ++i) {
        sum[i] = x[i] + fine_step_s / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    }
    return sum;
}

void take_acceleration(
    TripLog& trip, double t_s, const State& x, double road_m, const Vehicle& vehicle) {
    const double up_mps2 = rate_of(x, road_m, vehicle.half_car)[1];
    trip.acc.t_s.push_back(t_s);
    trip.acc.x.push_back(0);
    trip.acc.y.push_back(0);
    trip.acc.z.push_back(static_cast<float>(gravity_mps2 + vehicle.gain * up_mps2));
    trip.rows.push_back(row_content::acc);
}

} // namespace

GeoPoint place_of(const Drive& drive, double distance_m) {
    const double course_rad = drive.course_deg * std::numbers::pi / 180;
    const double per_degree_east =
        metres_per_degree * std::cos(drive.start.lat_deg * std::numbers::pi / 180);
    return {drive.start.lat_deg + std::round(std::cos(course_rad)) * distance_m / metres_per_degree,
            drive.start.lon_deg + std::round(std::sin(course_rad)) * distance_m / per_degree_east};
}

TripLog drive_over(const Road& road, const Drive& drive, const Vehicle& vehicle) {
    TripLog trip;
    trip.meta.trip_id = drive.trip_id;
    trip.meta.vehicle_id = drive.vehicle_id;
    trip.meta.gnss_latency_s = drive.gnss_latency_s;
    trip.meta.gnss_latency_stated = true;
    trip.sha256 = std::string(64, '0');

    const auto every = [](double hz) {
        return static_cast<int>(std::lround(1 / (hz * fine_step_s)));
    };
    const int acc_every = every(drive.rate_hz);
    const int fix_every = every(drive.gnss_hz);
    const auto steps = static_cast<int>(drive.length_m / drive.speed_mps / fine_step_s);
    State x{road(0), 0, road(0), 0};
    for (int k = 0; k <= steps; ++k) {
        const double t_s = k * fine_step_s;
        const double at_m = drive.speed_mps * t_s;
        if (k % acc_every == 0) {
            take_acceleration(trip, t_s, x, road(at_m), vehicle);
            if (drive.wheel_speed) {
                trip.speed.t_s.push_back(t_s);
                trip.speed.speed_mps.push_back(static_cast<float>(drive.speed_mps));
                trip.rows.back() |= row_content::speed;
            }
        }
        if (k % fix_every == 0) {
            const double seen_m = drive.speed_mps * (t_s - drive.gnss_latency_s);
            trip.fixes.push_back({t_s,
                                  place_of(drive, seen_m),
                                  static_cast<float>(drive.speed_mps),
                                  static_cast<float>(drive.course_deg),
                                  2.0F});
            trip.rows.push_back(row_content::fix);
        }
        const double next_m = fine_step_s * drive.speed_mps;
        x = stepped(
            x, {road(at_m), road(at_m + next_m / 2), road(at_m + next_m)}, vehicle.half_car);
    }
    return trip;
}

std::string text_of(const TripLog& trip, const Drive& drive) {
    auto text = fmt::format("# macadam-trip 1\n# trip_id: {}\n# vehicle_id: {}\n# t0_utc: {}\n"
                            "# frame: FLU\n# gravity: included\n# gnss_latency_s: {}\n"
                            "t_s,acc_x_mps2,acc_y_mps2,acc_z_mps2,speed_mps,lat_deg,lon_deg,"
                            "gnss_speed_mps,course_deg\n",
                            drive.trip_id,
                            drive.vehicle_id,
                            drive.t0_utc,
                            drive.gnss_latency_s);
    std::size_t rows = 0;
    std::size_t fix = 0;
    for (std::size_t i = 0; i < trip.acc.t_s.size(); ++i) {
        text +=
            fmt::format("{:.6f},{},{},{},{},,,,\n",
                        trip.acc.t_s[i],
                        trip.acc.x[i],
                        trip.acc.y[i],
                        trip.acc.z[i],
                        trip.speed.t_s.empty() ? "" : fmt::format("{}", trip.speed.speed_mps[i]));
        ++rows;
        for (; fix < trip.fixes.size() && trip.fixes[fix].t_s <= trip.acc.t_s[i]; ++fix, ++rows) {
            const auto& f = trip.fixes[fix];
            text += fmt::format("{:.6f},,,,,{:.8f},{:.8f},{},{}\n",
                                f.t_s,
                                f.at.lat_deg,
                                f.at.lon_deg,
                                f.speed_mps,
                                f.course_deg);
        }
    }
    return text + fmt::format("# end rows: {}\n", rows);
}

Road patched_road(std::function<bool(double)> is_rough, double factor) {
    return [is_rough = std::move(is_rough), factor](double x_m) {
        constexpr double turn = 2 * std::numbers::pi;
        const double wave_m = 0.001 * (std::sin(turn * x_m / 2.5) + std::sin(turn * x_m / 4.3) +
                                       2 * std::sin(turn * x_m / 13.7));
        return is_rough(x_m) ? factor * wave_m : wave_m;
    };
}

} // namespace macadam::testing
