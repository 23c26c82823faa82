#include "app/pipeline/trip_preparation.hpp"

#include "estimator/clocks/gnss_latency.hpp"
#include "estimator/common/error.hpp"
#include "estimator/common/gravity.hpp"
#include "estimator/motion/stretch.hpp"
#include "storage/trips/detection/detected_mapping.hpp"
#include "storage/trips/positions/joined_trip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace macadam {
namespace {

constexpr double slow_sampling_hz = 80; // below it the shortest waves of IRI are missed
constexpr double steep_tilt_deg = 15;   // beyond a careless mounting
constexpr double odd_scale = 0.05;      // wheel speed against GNSS
constexpr double odd_gravity = 0.1;     // sensors of cars and phones are accurate to 3 %

enum class Axis : int { lateral = 1, vertical = 2 };

/// Returns whether the sensor axis nearest to an axis of the vehicle has any readings.
bool was_sampled(const TripLog& trip, const Mounting& mounting, Axis axis) {
    const std::vector<float>* readings[] = {&trip.acc.x, &trip.acc.y, &trip.acc.z};
    Eigen::Index nearest = 0;
    mounting.to_vehicle.row(static_cast<int>(axis)).cwiseAbs().maxCoeff(&nearest);
    return std::ranges::any_of(*readings[nearest], [](float value) { return !std::isnan(value); });
}

} // namespace

std::vector<std::string> reading_notes(const TripMeta& meta) {
    std::vector<std::string> notes;
    if (const auto found = meta.other.find(detected_key); found != meta.other.end()) {
        notes.push_back(fmt::format("read as {} (detected); 'macadam inspect' shows the mapping",
                                    found->second));
    }
    if (const auto found = meta.other.find(positions_key); found != meta.other.end()) {
        notes.push_back(found->second);
    }
    return notes;
}

PreparedTrip prepared(TripLog trip, const OdometerConfig& config) {
    std::optional<TripMotion> motion;
    auto warnings = reading_notes(trip.meta);
    if (!trip.meta.gnss_latency_stated && !trip.fixes.empty()) {
        std::optional<FoundLatency> latency;
        if (const auto by_speeds_s = estimate_gnss_latency_s(trip)) {
            latency = {*by_speeds_s, latency_by_speeds_sd_s};
        } else if (trip.fixes.size() >= 2 && !(trip.speed.t_s.empty() && trip.gyro.t_s.empty())) {
            motion = motion_of(trip, config);
            latency = find_gnss_latency(trip, motion->heading);
        }
        if (latency) {
            trip.meta.gnss_latency_s = latency->latency_s;
            trip.meta.gnss_latency_sd_s = latency->sd_s;
            motion.reset();
            warnings.push_back(fmt::format("GNSS delay estimated at {:.2f} s", latency->latency_s));
        } else {
            warnings.emplace_back("GNSS delay unknown (no gnss_latency_s) and could not be "
                                  "estimated; positions may be off by up to 2 s of driving");
        }
    }
    if (!motion) {
        motion = motion_of(trip, config);
    }
    return {std::move(trip), std::move(*motion), std::move(warnings)};
}

void expect_channels(const TripLog& trip, const Mounting& mounting, Channels channels) {
    const bool vertical = was_sampled(trip, mounting, Axis::vertical);
    const bool lateral = was_sampled(trip, mounting, Axis::lateral);
    if (!vertical && (channels == Channels::vertical || channels == Channels::both)) {
        throw InputError{"contains no vertical acceleration, expected acc_z_mps2"};
    }
    if (!lateral && channels == Channels::lateral) {
        throw InputError{"contains no lateral acceleration, expected acc_y_mps2"};
    }
    if (!vertical && !lateral) {
        throw InputError{"contains neither vertical nor lateral acceleration, expected "
                         "acc_z_mps2"};
    }
}

std::vector<std::string>
warnings_of(const TripLog& trip, const Odometer& odometer, const Mounting& mounting) {
    std::vector<std::string> warnings;
    if (trip.acc.t_s.size() > 1) {
        const double hz = 1 / median_step_s(trip.acc.t_s);
        if (hz > 0 && hz < slow_sampling_hz) {
            warnings.push_back(fmt::format(
                "acceleration was sampled at {:.0f} Hz; short waves are missed below {:.0f} Hz",
                hz,
                slow_sampling_hz));
        }
    }
    if (mounting.moved) {
        warnings.emplace_back("gravity changed: the sensor moved during the trip");
    }
    if (mounting.gravity_mps2 > 0 &&
        std::abs(mounting.gravity_mps2 / standard_gravity_mps2 - 1) > odd_gravity) {
        warnings.push_back(fmt::format("gravity measures {:.2f} m/s2: the accelerometer's "
                                       "scale is wrong, or the sensor moved in the car",
                                       mounting.gravity_mps2));
    }
    if (!trip.meta.gravity_included && trip.meta.frame == Frame::sensor &&
        !trip.meta.mount_rpy_deg && !trip.meta.mount_quat) {
        warnings.emplace_back("the log has no gravity: the z axis is taken as vertical");
    }
    if (mounting.tilt_deg > steep_tilt_deg) {
        warnings.push_back(
            fmt::format("the sensor was tilted by {:.0f} degrees; corrected", mounting.tilt_deg));
    }
    if (std::abs(odometer.scale() - 1) > odd_scale) {
        warnings.push_back(fmt::format("wheel speed differed from GNSS speed by {:+.1f} %; "
                                       "corrected",
                                       100 * (1 / odometer.scale() - 1)));
    }
    if (mounting.gravity_missing) {
        warnings.emplace_back(
            "no gravity in the acceleration, although the log says that it is included; the "
            "axes are taken as stated");
    }
    if (mounting.heading_unknown) {
        warnings.emplace_back(
            "the heading of the sensor could not be determined: too little braking and "
            "accelerating; lateral acceleration is unreliable");
    }
    if (trip.meta.frame_stated && trip.meta.frame != Frame::sensor &&
        (trip.meta.mount_rpy_deg || trip.meta.mount_quat)) {
        warnings.emplace_back("the mounting angles were not applied: they require 'frame: sensor'");
    }
    for (const auto& column : trip.unknown_columns) {
        warnings.push_back(fmt::format("unknown column '{}' ignored", column));
    }
    return warnings;
}

} // namespace macadam
