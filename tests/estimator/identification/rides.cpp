#include "rides.hpp"

#include "estimator/common/gravity.hpp"
#include "estimator/simulation/linear_ride.hpp"

#include <cmath>
#include <numbers>

namespace macadam::testing {

RoadProfile rough_profile(double length_m, double from_m, unsigned seed) {
    RoadProfile profile{.station_m = {},
                        .left_m = iso_road(length_m, 2, seed),
                        .right_m = iso_road(length_m, 2, seed + 1)};
    for (std::size_t i = 0; i < profile.left_m.size(); ++i) {
        profile.station_m.push_back(from_m + 0.05 * static_cast<double>(i));
    }
    return profile;
}

RoadProfile profile_of(const RoadSurface& surface) {
    const auto paths = wheel_paths(surface);
    RoadProfile profile{.station_m = {}, .left_m = paths.left_m, .right_m = paths.right_m};
    for (std::size_t i = 0; i < paths.left_m.size(); ++i) {
        profile.station_m.push_back(paths.step_m * static_cast<double>(i));
    }
    return profile;
}

Stretch one_axle_ride(const Vehicle& vehicle,
                      const RoadProfile& profile,
                      double speed_mps,
                      double rate_hz) {
    const double length_m = profile.station_m.back() - profile.station_m.front();
    return stretch_of(drive(
                          vehicle,
                          along(profile.left_m, 0.05),
                          along(profile.right_m, 0.05),
                          length_m - 1,
                          [=](double) { return speed_mps; },
                          rate_hz,
                          static_cast<int>(2000 / rate_hz)),
                      true,
                      true);
}

Stretch two_axle_ride(const CarRecipe& car,
                      const RoadSurface& surface,
                      const Motion& motion,
                      double rate_hz,
                      double lowpass_hz) {
    const auto paths = wheel_paths(surface);
    const RoadUnderWheels road{.step_m = paths.step_m,
                               .left_m = {paths.left_m.begin(), paths.left_m.end()},
                               .right_m = {paths.right_m.begin(), paths.right_m.end()}};
    ImuRecipe imu = perfect_imu(rate_hz);
    imu.noise_mps2 = 0.05;
    imu.lowpass_hz = lowpass_hz;
    const auto readings = simulate_imu(car, imu, road, motion, 3);

    Stretch stretch{};
    stretch.step_s = 1 / rate_hz;
    for (std::size_t i = 0; i < readings.t_s.size(); ++i) {
        const double step = readings.t_s[i] / motion.step_s;
        const auto k = std::min(static_cast<std::size_t>(step), motion.travel_m.size() - 2);
        const double part = step - static_cast<double>(k);
        stretch.travel_m.push_back(std::lerp(motion.travel_m[k], motion.travel_m[k + 1], part));
        stretch.speed_mps.push_back(static_cast<float>(motion.speed_mps[k]));
        stretch.vertical_mps2.push_back(readings.acc_mps2[i][2] -
                                        static_cast<float>(standard_gravity_mps2));
        stretch.lateral_mps2.push_back(readings.acc_mps2[i][1]);
    }
    return stretch;
}

Motion swinging_motion(double slow_mps, double quick_mps, double period_s, double duration_s) {
    Motion motion{
        .step_s = 0.1, .travel_m = {}, .speed_mps = {}, .acc_mps2 = {}, .yaw_rate_radps = {}};
    const double middle = (slow_mps + quick_mps) / 2;
    const double swing = (quick_mps - slow_mps) / 2;
    const double w = 2 * std::numbers::pi / period_s;
    for (int i = 0; i <= static_cast<int>(duration_s * 10 + 0.5); ++i) {
        const double t = 0.1 * i;
        motion.travel_m.push_back(middle * t + swing / w * (1 - std::cos(w * t)));
        motion.speed_mps.push_back(middle + swing * std::sin(w * t));
        motion.acc_mps2.push_back(swing * w * std::cos(w * t));
        motion.yaw_rate_radps.push_back(0);
    }
    return motion;
}

} // namespace macadam::testing
