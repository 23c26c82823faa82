#include "estimator/identification/likelihood/profile_drive.hpp"

#include "estimator/common/gravity.hpp"
#include "estimator/smoother/stretch_record.hpp"
#include "estimator/vehicle/linear_system.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace macadam {
namespace {

constexpr double road_step_m = 0.025; // a wave of 1 m in 40 straight lines: error 0.2 %
constexpr double finest_step_s = 0.0025;
constexpr double spare_road_m = 10; // before and behind the axles, where the profile goes on

constexpr double max_friction_per_step = 0.6; // friction * step / (slip * mu); 1 would oscillate

constexpr int states = LinearCar::states;
constexpr int roads = LinearCar::inputs;
constexpr int axle_forces = 4; // mean at the front, at the rear; half difference likewise
using State = Eigen::Vector<double, states>;
using Roads = Eigen::Vector<double, roads>;
using Forces = Eigen::Vector<double, axle_forces>;

// States of LinearCar whose rates follow them.
constexpr int heave = 0;
constexpr int pitch = 2;
constexpr int front_mean = 4;
constexpr int rear_mean = 6;
constexpr int roll = 8;
constexpr int front_half = 10;
constexpr int rear_half = 12;

/// Returns the profile between two stations, or to its ends.
EvenRoad even_road(const RoadProfile& profile, double from_m, double to_m) {
    from_m = std::max(from_m, profile.station_m.front());
    to_m = std::min(to_m, profile.station_m.back());
    EvenRoad road{.first_m = from_m, .step_m = road_step_m, .elevation_m = {}};
    const auto count = static_cast<std::size_t>((to_m - from_m) / road_step_m);
    std::vector<double> at_m(count + 1);
    for (std::size_t i = 0; i <= count; ++i) {
        at_m[i] = road.first_m + road_step_m * static_cast<double>(i);
    }
    const auto left = elevations_at(profile.station_m, profile.left_m, at_m);
    const auto right = elevations_at(profile.station_m, profile.right_m, at_m);
    for (std::size_t i = 0; i <= count; ++i) {
        road.elevation_m.push_back(
            {.mean = (left[i] + right[i]) / 2, .half = (left[i] - right[i]) / 2});
    }
    return road;
}

/// Smooths the road by an exponential filter in both directions.
EvenRoad smoothed(EvenRoad road, double length_m) {
    const double keep = std::exp(-road.step_m / length_m);
    const auto one_way = [keep](auto begin, auto end) {
        Pair last = *begin;
        for (auto at = begin; at != end; ++at) {
            last = {.mean = at->mean + keep * (last.mean - at->mean),
                    .half = at->half + keep * (last.half - at->half)};
            *at = last;
        }
    };
    one_way(road.elevation_m.begin(), road.elevation_m.end());
    one_way(road.elevation_m.rbegin(), road.elevation_m.rend());
    return road;
}

Pair elevation_at(const EvenRoad& road, double station_m) {
    const auto last = static_cast<double>(road.elevation_m.size() - 1);
    const double at = std::clamp((station_m - road.first_m) / road.step_m, 0.0, last);
    const auto i = std::min(static_cast<std::size_t>(at), road.elevation_m.size() - 2);
    const double part = at - static_cast<double>(i);
    const Pair& a = road.elevation_m[i];
    const Pair& b = road.elevation_m[i + 1];
    return {.mean = std::lerp(a.mean, b.mean, part), .half = std::lerp(a.half, b.half, part)};
}

double pitch_kgm2(const Vehicle& vehicle) {
    const auto& axles = *vehicle.axles;
    return axles.dynamic_index * vehicle.half_car.ms_kg * axles.cg_to_front_m *
           (axles.wheelbase_m - axles.cg_to_front_m);
}

/// Returns the effect of additional suspension forces, up on the body and down on the wheels.
Eigen::Matrix<double, states, axle_forces> force_columns(const Vehicle& vehicle) {
    const auto& half_car = vehicle.half_car;
    const auto& axles = *vehicle.axles;
    const double ahead_m = axles.cg_to_front_m;
    const double behind_m = axles.wheelbase_m - ahead_m;
    Eigen::Matrix<double, states, axle_forces> columns;
    columns.setZero();
    columns(heave + 1, 0) = columns(heave + 1, 1) = 2 / half_car.ms_kg;
    columns(pitch + 1, 0) = -2 * ahead_m / pitch_kgm2(vehicle);
    columns(pitch + 1, 1) = 2 * behind_m / pitch_kgm2(vehicle);
    columns(roll + 1, 2) = columns(roll + 1, 3) = half_car.l_m / half_car.is_kgm2;
    columns(front_mean + 1, 0) = columns(rear_mean + 1, 1) = -1 / half_car.mu_kg;
    columns(front_half + 1, 2) = columns(rear_half + 1, 3) = -1 / half_car.mu_kg;
    return columns;
}

/// Car in discrete time, with the forces that a linear car lacks.
class SteppedCar {
public:
    SteppedCar(const FittedCar& fitted, double step_s)
        : vehicle_{fitted.vehicle}, car_{linear_car(fitted.vehicle)}, rebound_excess_{
                                                                          fitted.rebound_excess} {
        slip_mps_ = std::max(fitted.slip_mps,
                             *vehicle_.half_car.friction_n * step_s /
                                 (max_friction_per_step * vehicle_.half_car.mu_kg));
        add_weight(fitted.pitch_arm_m, fitted.roll_arm_m);
        const auto force = force_columns(vehicle_);
        constexpr int size = states + 2 * roads + axle_forces;
        Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(size, size);
        whole.topLeftCorner(states, states) = car_.a * step_s;
        whole.block(0, states, states, roads) = car_.b * step_s;
        whole.block(states, states + roads, roads, roads).setIdentity();
        whole.block(0, states + 2 * roads, states, axle_forces) = force * step_s;
        const Eigen::MatrixXd moved = exponential(whole);
        const Eigen::MatrixXd at_end = moved.block(0, states + roads, states, roads);
        phi_ = moved.topLeftCorner(states, states);
        end_ = at_end;
        begin_ = moved.block(0, states, states, roads) - at_end;
        force_ = moved.block(0, states + 2 * roads, states, axle_forces);

        const auto& imu = vehicle_.imu;
        felt_force_.setZero();
        felt_force_.row(0) =
            force.row(heave + 1) - imu.x_m * force.row(pitch + 1) + imu.y_m * force.row(roll + 1);
        felt_force_.row(1) = -imu.height_above_roll_axis_m * force.row(roll + 1);
    }

    /// Returns the forces of friction, and what the dampers exert beside their mean.
    Forces forces(const State& x) const {
        const auto& half_car = vehicle_.half_car;
        const auto& axles = *vehicle_.axles;
        const double ratio = axles.rear_ratio;
        const double front_rate = x[front_mean + 1] - x[heave + 1] + car_.front_m * x[pitch + 1];
        const double rear_rate = x[rear_mean + 1] - x[heave + 1] + car_.rear_m * x[pitch + 1];
        const double front_diff = x[front_half + 1] - half_car.l_m * x[roll + 1];
        const double rear_diff = x[rear_half + 1] - half_car.l_m * x[roll + 1];
        const auto force = [&](double rate, double share) {
            return *half_car.friction_n * rate / std::sqrt(rate * rate + slip_mps_ * slip_mps_) -
                   share * rebound_excess_ * half_car.cs_ns_per_m * std::abs(rate);
        };
        const double front = 2 / (1 + ratio);
        const double fl = force(front_rate + front_diff, front);
        const double fr = force(front_rate - front_diff, front);
        const double rl = force(rear_rate + rear_diff, ratio * front);
        const double rr = force(rear_rate - rear_diff, ratio * front);
        return {(fl + fr) / 2, (rl + rr) / 2, (fl - fr) / 2, (rl - rr) / 2};
    }

    State next(const State& x, const Roads& from, const Roads& to, const Forces& force) const {
        State y = phi_ * x;
        y.noalias() += begin_ * from;
        y.noalias() += end_ * to;
        y.noalias() += force_ * force;
        return y;
    }

    double felt(std::size_t channel, const State& x, const Forces& force) const {
        return car_.felt[channel].dot(x) +
               felt_force_.row(static_cast<Eigen::Index>(channel)).dot(force);
    }

    Roads under(const EvenRoad& road, double station_m) const {
        const auto front = elevation_at(road, station_m + car_.front_m);
        const auto rear = elevation_at(road, station_m + car_.rear_m);
        return {front.mean, rear.mean, front.half, rear.half};
    }

    State at_rest(const Roads& road) const {
        const double wheelbase_m = car_.front_m - car_.rear_m;
        State x = State::Zero();
        x[front_mean] = road[0];
        x[rear_mean] = road[1];
        x[front_half] = road[2];
        x[rear_half] = road[3];
        x[heave] = (car_.front_m * road[1] - car_.rear_m * road[0]) / wheelbase_m;
        x[pitch] = (road[1] - road[0]) / wheelbase_m;
        x[roll] = (road[2] + road[3]) / 2 / vehicle_.half_car.l_m;
        return x;
    }

private:
    /// Adds the moments of the weight, which a linear car lacks.
    void add_weight(double pitch_arm_m, double roll_arm_m) {
        const auto& imu = vehicle_.imu;
        const double weight_n = vehicle_.half_car.ms_kg * standard_gravity_mps2;
        const double by_pitch = pitch_arm_m * weight_n / pitch_kgm2(vehicle_);
        const double by_roll = roll_arm_m * weight_n / (2 * vehicle_.half_car.is_kgm2);
        car_.a(pitch + 1, pitch) += by_pitch;
        car_.a(roll + 1, roll) += by_roll;
        car_.felt[0][pitch] -= imu.x_m * by_pitch;
        car_.felt[0][roll] += imu.y_m * by_roll;
        car_.felt[1][roll] -= imu.height_above_roll_axis_m * by_roll;
    }

    Vehicle vehicle_;
    LinearCar car_;
    double rebound_excess_;
    double slip_mps_ = 0;
    Eigen::Matrix<double, states, states> phi_;
    Eigen::Matrix<double, states, roads> begin_, end_;
    Eigen::Matrix<double, states, axle_forces> force_;
    Eigen::Matrix<double, channel_count, axle_forces> felt_force_;
};

bool tracks_differ(const RoadProfile& profile) {
    return profile.left_m != profile.right_m;
}

/// Returns the channels that determine a car.
SensorSet channels_for(const Stretch& stretch, const RoadProfile& profile, const Vehicle& vehicle) {
    const bool rolls = tracks_differ(profile);
    const bool has_roll = rolls && !stretch.roll_radps.empty();
    return {.vertical = true,
            .lateral = rolls && !has_roll && vehicle.imu.height_above_roll_axis_m > 0,
            .roll = has_roll,
            .pitch = true,
            .yaw = true};
}

} // namespace

std::optional<ProfileDrive> drive_on_profile(const Stretch& stretch,
                                             const RoadProfile& profile,
                                             const Vehicle& vehicle,
                                             double at_m) {
    const auto& axles = *vehicle.axles;
    const double first_m =
        profile.station_m.front() + axles.wheelbase_m - axles.cg_to_front_m - at_m;
    const double last_m = profile.station_m.back() - axles.cg_to_front_m - at_m;
    auto from = std::ranges::lower_bound(stretch.travel_m, first_m);
    auto to = std::ranges::upper_bound(stretch.travel_m, last_m);
    if (to - from < 2 || stretch.vertical_mps2.empty()) {
        return std::nullopt;
    }
    const double whole_m = *(to - 1) - *from;
    if (whole_m > max_drive_m) {
        const double middle_m = std::midpoint(*from, *(to - 1));
        from = std::lower_bound(from, to, middle_m - max_drive_m / 2);
        to = std::upper_bound(from, to, middle_m + max_drive_m / 2);
    }
    EstimatorConfig config;
    config.sensors = channels_for(stretch, profile, vehicle);
    auto record = piece_of(drive_of(stretch, vehicle, config),
                           static_cast<std::size_t>(from - stretch.travel_m.begin()),
                           static_cast<std::size_t>(to - stretch.travel_m.begin()));
    ProfileDrive drive{.step_s = stretch.step_s,
                       .station_m = std::move(record.travel_m),
                       .felt = std::move(record.felt),
                       .road = {},
                       .left_out_m = std::max(0.0, whole_m - max_drive_m)};
    std::ranges::for_each(drive.station_m, [=](double& station) { station += at_m; });
    const double around_m = axles.wheelbase_m + spare_road_m;
    drive.road =
        even_road(profile, drive.station_m.front() - around_m, drive.station_m.back() + around_m);
    return drive;
}

Readings simulated_readings(const ProfileDrive& drive,
                            const FittedCar& fitted,
                            double file_gain,
                            std::span<const double> shift_m) {
    const auto road = smoothed(drive.road, fitted.smoothing_m);
    const auto parts = static_cast<int>(std::ceil(drive.step_s / finest_step_s - 1e-9));
    const SteppedCar car{fitted, drive.step_s / parts};
    const double gain = fitted.vehicle.gain / file_gain;
    const auto station = [&](std::size_t k) { return drive.station_m[k] + shift_m[k]; };

    Readings readings;
    Roads under = car.under(road, station(0));
    State x = car.at_rest(under);
    Forces before = Forces::Zero();
    for (std::size_t k = 0; k < drive.station_m.size(); ++k) {
        const Forces now = car.forces(x);
        for (std::size_t channel = 0; channel < channel_count; ++channel) {
            if (!drive.felt[channel].empty()) {
                readings[channel].push_back((channel < 2 ? gain : 1) * car.felt(channel, x, now));
            }
        }
        for (int part = 1; part <= parts && k + 1 < drive.station_m.size(); ++part) {
            const Forces force = car.forces(x);
            const Roads next = car.under(
                road, std::lerp(station(k), station(k + 1), static_cast<double>(part) / parts));
            x = car.next(x, under, next, 1.5 * force - 0.5 * before);
            before = force;
            under = next;
        }
    }
    return readings;
}

} // namespace macadam
