#include "estimator/motion/mounting.hpp"

#include "estimator/common/angle.hpp"
#include "estimator/common/gravity.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

namespace macadam {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double window_s = 1;      // long against vibration, short against braking
constexpr double steady_mps2 = 0.5; // limit of neither braking nor accelerating
constexpr double chunk_s = 30;      // hills and bends average out
constexpr double wander_deg = 8;    // a 10 % grade is 5.7 degrees, camber 1.5
constexpr double forever_s = std::numeric_limits<double>::infinity();
constexpr double wander_mps2 = 1; // ten times the effect of hills and bends over half a minute
constexpr double other_deg = 20;  // the vertical is measured 6 % too weak, and worse beyond
constexpr double steepest_pull_deg = 25; // 4.6 m/s2, more than drivers sustain half a minute
constexpr double brisk_mps2 = 0.5;       // braking that shows the forward direction
constexpr std::size_t min_brisk = 8;

// Standard gravity within a scale error of 25 % and a hill. Any other value is not gravity: an axis
// is missing, or gravity was removed without being declared.
constexpr double min_gravity_mps2 = 7;
constexpr double max_gravity_mps2 = 13;

/// Mean specific force of about a second, in the sensor's axes, and the change of speed.
struct Window {
    double middle_s;
    Vector3d force_mps2;
    double gain_mps2; ///< of the speed; NaN where it is not known
};

double or_zero(float value) {
    return std::isnan(value) ? 0 : static_cast<double>(value);
}

std::vector<Window> windows_of(const TriaxialSamples& acc, const Odometer& odometer) {
    std::vector<Window> windows;
    std::size_t begin = 0;
    while (begin < acc.t_s.size()) {
        Vector3d sum = Vector3d::Zero();
        std::size_t end = begin;
        for (; end < acc.t_s.size() && acc.t_s[end] - acc.t_s[begin] < window_s; ++end) {
            sum += Vector3d{or_zero(acc.x[end]), or_zero(acc.y[end]), or_zero(acc.z[end])};
        }
        const double from_s = acc.t_s[begin];
        const double to_s = acc.t_s[end - 1];
        if (to_s - from_s > window_s / 2) {
            const double gain_mps = odometer.speed_mps(to_s) - odometer.speed_mps(from_s);
            windows.push_back({.middle_s = (from_s + to_s) / 2,
                               .force_mps2 = sum / static_cast<double>(end - begin),
                               .gain_mps2 = gain_mps / (to_s - from_s)});
        }
        begin = end;
    }
    return windows;
}

Vector3d median(std::vector<Vector3d> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    Vector3d result;
    for (int axis = 0; axis < 3; ++axis) {
        std::ranges::nth_element(values, middle, {}, [=](const Vector3d& v) { return v[axis]; });
        result[axis] = (*middle)[axis];
    }
    return result;
}

/// Returns the mean force while neither braking nor accelerating; of all windows if there are few
/// such.
Vector3d steady_force(std::span<const Window> windows) {
    std::vector<Vector3d> steady;
    std::vector<Vector3d> all;
    all.reserve(windows.size());
    for (const auto& window : windows) {
        all.push_back(window.force_mps2);
        if (std::abs(window.gain_mps2) < steady_mps2) {
            steady.push_back(window.force_mps2);
        }
    }
    return median(steady.size() * 4 >= all.size() ? std::move(steady) : std::move(all));
}

double angle_deg(const Vector3d& a, const Vector3d& b) {
    return deg_per_rad * std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Specific force of about half a minute relative to that of the whole trip.
struct Chunk {
    TimeSpan time;
    double off_deg;
    double off_mps2; ///< positive: stronger
};

/// Divides the trip into chunks. A last chunk that is too short to be judged is equal to the one
/// before it.
std::vector<Chunk> chunks_of(const std::vector<Window>& windows, const Vector3d& gravity) {
    std::vector<Chunk> chunks;
    std::size_t begin = 0;
    while (begin < windows.size()) {
        std::size_t end = begin;
        while (end < windows.size() && windows[end].middle_s - windows[begin].middle_s < chunk_s) {
            ++end;
        }
        // Chunks share their borders, and the outermost extend to the ends of the trip.
        const TimeSpan time{begin == 0 ? -forever_s : windows[begin].middle_s - window_s / 2,
                            end == windows.size() ? forever_s
                                                  : windows[end].middle_s - window_s / 2};
        if (static_cast<double>(end - begin) * window_s > chunk_s / 2) {
            const auto force = steady_force(std::span{windows}.subspan(begin, end - begin));
            chunks.push_back({time, angle_deg(force, gravity), force.norm() - gravity.norm()});
        } else if (!chunks.empty()) {
            chunks.push_back({time, chunks.back().off_deg, chunks.back().off_mps2});
        }
        begin = end;
    }
    return chunks;
}

/// Returns true if braking or a bend tilts the specific force: both add a component to gravity, so
/// that the total is the hypotenuse. A sensor with another orientation measures the same gravity in
/// another direction.
bool is_pulled(const Chunk& chunk) {
    const double by_pull_mps2 = standard_gravity_mps2 / std::cos(chunk.off_deg / deg_per_rad);
    return chunk.off_deg < steepest_pull_deg &&
           chunk.off_mps2 > (by_pull_mps2 - standard_gravity_mps2) / 2;
}

bool hangs_otherwise(const Chunk& chunk, double min_deg) {
    return std::abs(chunk.off_mps2) > wander_mps2 || (chunk.off_deg > min_deg && !is_pulled(chunk));
}

bool wandered(const std::vector<Chunk>& chunks) {
    return std::ranges::any_of(
        chunks, [](const Chunk& chunk) { return hangs_otherwise(chunk, wander_deg); });
}

/// Returns the times at which the rotation that fits the whole trip does not fit.
std::vector<TimeSpan> hung_otherwise(const std::vector<Chunk>& chunks) {
    std::vector<TimeSpan> spans;
    for (const auto& chunk : chunks) {
        if (hangs_otherwise(chunk, other_deg)) {
            spans.push_back(chunk.time);
        }
    }
    return spans;
}

/// Intrinsic z-y-x: yaw, then pitch, then roll.
Matrix3d rotation_of_rpy(const std::array<double, 3>& rpy_deg) {
    using Eigen::AngleAxisd;
    return (AngleAxisd{rpy_deg[2] / deg_per_rad, Vector3d::UnitZ()} *
            AngleAxisd{rpy_deg[1] / deg_per_rad, Vector3d::UnitY()} *
            AngleAxisd{rpy_deg[0] / deg_per_rad, Vector3d::UnitX()})
        .toRotationMatrix();
}

/// Returns the frame of the readings. Mounting angles refer to the device's axes: where the log
/// names no frame, they imply that it is the device's.
Frame frame_of(const TripMeta& meta) {
    const bool mounted = meta.mount_quat || meta.mount_rpy_deg;
    return mounted && !meta.frame_stated ? Frame::sensor : meta.frame;
}

Matrix3d stated_rotation(const TripMeta& meta) {
    switch (frame_of(meta)) {
    case Frame::flu:
        return Matrix3d::Identity();
    case Frame::frd:
        return Vector3d{1, -1, -1}.asDiagonal();
    case Frame::sensor:
        break;
    }
    if (meta.mount_quat) {
        const auto& [w, x, y, z] = *meta.mount_quat;
        return Eigen::Quaterniond{w, x, y, z}.normalized().toRotationMatrix();
    }
    return meta.mount_rpy_deg ? rotation_of_rpy(*meta.mount_rpy_deg) : Matrix3d::Identity();
}

/// Returns the rotation about the vertical that aligns braking and accelerating with the x axis;
/// `std::nullopt` if the trip did not brake enough.
std::optional<Matrix3d> heading(const std::vector<Window>& windows, const Matrix3d& level) {
    Eigen::Vector2d forward = Eigen::Vector2d::Zero();
    std::size_t brisk = 0;
    for (const auto& window : windows) {
        if (std::abs(window.gain_mps2) > brisk_mps2) {
            forward += window.gain_mps2 * (level * window.force_mps2).head<2>();
            ++brisk;
        }
    }
    if (brisk < min_brisk || forward.norm() == 0) {
        return std::nullopt;
    }
    return Eigen::AngleAxisd{-std::atan2(forward.y(), forward.x()), Vector3d::UnitZ()}
        .toRotationMatrix();
}

} // namespace

Mounting estimate_mounting(const TripLog& trip, const Odometer& odometer) {
    const Matrix3d stated = stated_rotation(trip.meta);
    Mounting mounting{.to_vehicle = stated,
                      .gravity_mps2 = 0,
                      .tilt_deg = 0,
                      .moved = false,
                      .otherwise = {},
                      .gravity_missing = false,
                      .heading_unknown = false};
    const auto windows = windows_of(trip.acc, odometer);
    if (windows.empty()) {
        return mounting;
    }
    const Vector3d gravity = steady_force(windows);
    mounting.gravity_missing = trip.meta.gravity_included && !(gravity.norm() > min_gravity_mps2 &&
                                                               gravity.norm() < max_gravity_mps2);
    if (trip.meta.gravity_included && !mounting.gravity_missing) {
        mounting.gravity_mps2 = gravity.norm();
        mounting.tilt_deg = angle_deg(stated * gravity, Vector3d::UnitZ());
        const auto chunks = chunks_of(windows, gravity);
        mounting.moved = wandered(chunks);
        mounting.otherwise = hung_otherwise(chunks);
        mounting.to_vehicle =
            Eigen::Quaterniond::FromTwoVectors(stated * gravity, Vector3d::UnitZ())
                .toRotationMatrix() *
            stated;
    }
    const bool mount_stated = trip.meta.mount_quat || trip.meta.mount_rpy_deg;
    const bool turn_unknown =
        trip.meta.mount_auto || (frame_of(trip.meta) == Frame::sensor && !mount_stated);
    if (const auto turn = turn_unknown ? heading(windows, mounting.to_vehicle) : std::nullopt) {
        mounting.to_vehicle = *turn * mounting.to_vehicle;
    } else {
        mounting.heading_unknown = turn_unknown;
    }
    return mounting;
}

} // namespace macadam
