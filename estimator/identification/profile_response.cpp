#include "estimator/identification/profile_response.hpp"

#include "estimator/vehicle/quarter_car.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

namespace macadam {
namespace {

constexpr double finest_step_s = 0.0025; // a wave of 15 Hz in 27 straight lines: error 0.5 %

/// Samples [first, last) that lie on the profile.
struct Piece {
    std::size_t first;
    std::size_t last;
};

Piece piece_on(const Stretch& stretch, const RoadProfile& profile, double at_m) {
    const auto& travel_m = stretch.travel_m;
    const auto first = std::ranges::lower_bound(travel_m, profile.station_m.front() - at_m);
    const auto last = std::ranges::upper_bound(travel_m, profile.station_m.back() - at_m);
    return {static_cast<std::size_t>(first - travel_m.begin()),
            static_cast<std::size_t>(std::max(first, last) - travel_m.begin())};
}

std::vector<double> cut(const std::vector<float>& samples, const Piece& piece) {
    if (samples.empty()) {
        return {};
    }
    const auto at = [&](std::size_t i) { return samples.begin() + static_cast<std::ptrdiff_t>(i); };
    return {at(piece.first), at(piece.last)};
}

/// Returns the stations under the car, `parts` per sample.
std::vector<double> fine_stations(const Stretch& stretch, Piece piece, double at_m, int parts) {
    std::vector<double> stations_m;
    for (std::size_t i = piece.first; i + 1 < piece.last; ++i) {
        for (int part = 0; part < parts; ++part) {
            stations_m.push_back(at_m + std::lerp(stretch.travel_m[i],
                                                  stretch.travel_m[i + 1],
                                                  double(part) / parts));
        }
    }
    stations_m.push_back(at_m + stretch.travel_m[piece.last - 1]);
    return stations_m;
}

/// Converts a system to one driven by the rate of the road. The road becomes a state, so that it is
/// linear between samples where `discretise` alone would make steps.
template <int States, int Inputs>
LinearSystem<States + Inputs, Inputs, 1>
driven_by_rates(const LinearSystem<States, Inputs, 1>& car) {
    LinearSystem<States + Inputs, Inputs, 1> driven;
    driven.a.setZero();
    driven.a.template topLeftCorner<States, States>() = car.a;
    driven.a.template topRightCorner<States, Inputs>() = car.b;
    driven.b.setZero();
    driven.b.template bottomRows<Inputs>().setIdentity();
    driven.c.setZero();
    driven.c.template leftCols<States>() = car.c;
    return driven;
}

template <int States, int Inputs>
std::vector<double> response(const LinearSystem<States, Inputs, 1>& car,
                             const ProfileResponse& ride,
                             const std::array<std::vector<double>, Inputs>& road_m) {
    using Road = Eigen::Vector<double, Inputs>;
    const auto road_at = [&](std::size_t i) {
        Road road;
        for (std::size_t track = 0; track < Inputs; ++track) {
            road[static_cast<Eigen::Index>(track)] = road_m[track][i];
        }
        return road;
    };
    const double step_s = ride.step_s / ride.road_per_sample;
    const auto steps = discretise(driven_by_rates(car), step_s);
    Eigen::Vector<double, States + Inputs> state;
    state.template head<States>() = -car.a.fullPivLu().solve(car.b * road_at(0));
    state.template tail<Inputs>() = road_at(0);

    std::vector<double> felt;
    felt.reserve(ride.vertical_mps2.size());
    const auto per_sample = static_cast<std::size_t>(ride.road_per_sample);
    for (std::size_t i = 0; i < road_m[0].size(); ++i) {
        if (i % per_sample == 0) {
            felt.push_back(steps.c * state);
        }
        if (i + 1 < road_m[0].size()) {
            const Road rate = (road_at(i + 1) - road_at(i)) / step_s;
            state = steps.a * state + steps.b * rate;
        }
    }
    return felt;
}

} // namespace

std::optional<ProfileResponse>
simulate_response(const Stretch& stretch, const RoadProfile& profile, double at_m) {
    const auto piece = piece_on(stretch, profile, at_m);
    if (piece.last < piece.first + 2) {
        return std::nullopt;
    }
    const int parts = std::max(1, static_cast<int>(std::ceil(stretch.step_s / finest_step_s)));
    const auto stations_m = fine_stations(stretch, piece, at_m, parts);
    return ProfileResponse{.step_s = stretch.step_s,
                           .vertical_mps2 = cut(stretch.vertical_mps2, piece),
                           .lateral_mps2 = cut(stretch.lateral_mps2, piece),
                           .road_per_sample = parts,
                           .left_m = elevations_at(profile.station_m, profile.left_m, stations_m),
                           .right_m = elevations_at(profile.station_m, profile.right_m, stations_m),
                           .from_m = stations_m.front(),
                           .to_m = stations_m.back()};
}

std::vector<double> vertical_response(const ProfileResponse& ride, const HalfCar& car) {
    std::vector<double> mean_m(ride.left_m.size());
    std::ranges::transform(
        ride.left_m, ride.right_m, mean_m.begin(), [](double l, double r) { return (l + r) / 2; });
    return response<4, 1>(quarter_car(car), ride, {std::move(mean_m)});
}

std::vector<double>
lateral_response(const ProfileResponse& ride, const HalfCar& car, double height_above_roll_axis_m) {
    return response<8, 2>(
        lateral_half_car(car, height_above_roll_axis_m), ride, {ride.left_m, ride.right_m});
}

} // namespace macadam
