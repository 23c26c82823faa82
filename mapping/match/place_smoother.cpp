#include "mapping/match/place_smoother.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace macadam {
namespace {

enum State : int { lead, scale, lane, lane_oneway, latency, east, north, zero, states };

using Vector = Eigen::Matrix<double, states, 1>;
using Square = Eigen::Matrix<double, states, states>;

constexpr int rounds = 3; // by then the places stand still to centimetres

constexpr double prior_lead_sd_m = 30;
constexpr double prior_lane_sd_m = 3; // to either side of the road
constexpr double prior_oneway_sd_m = 2;
constexpr double prior_zero_sd_rad = 1;

constexpr double lead_walk = 0.001;       // m2 per m: a map's bends are not a car's, 0.3 m in 100 m
constexpr double lead_walk_turning = 0.5; // m2 per rad: corners are cut as the driver likes
constexpr double lead_walk_unmeasured = 2; // m2 per m: travel drawn from positions
constexpr double lane_walk = 5e-4;         // m2 per m: 0.5 m in 500 m
constexpr double scale_walk = 1e-11;       // per m: 1e-3 in 100 km
constexpr double latency_walk = 1e-7;      // s2 per s: 0.02 s in an hour
constexpr double zero_walk = 1e-6;         // rad2 per s, beside the gyro's own

constexpr double slow_error_s = 30;     // a receiver's error is alike so long
constexpr double quick_error_m = 0.7;   // what is new at every fix
constexpr double map_sd_m = 0.7;        // the line across the road, ...
constexpr double map_length_m = 100;    // ... alike over so much
constexpr double heading_sd_rad = 0.07; // of the line against the car, ...
constexpr double bend_sd_m = 1.5;       // ... and where on it a bend is driven
constexpr double credible = 9;          // squared sds: beyond, a measurement counts less

struct Belief {
    Vector mean;
    Square variance;
};

Vector prior_mean(const DrivenLine& line, const Epoch& first, double nominal_m, double half_m) {
    Vector mean = Vector::Zero();
    mean[lead] = nominal_m - first.travel_m;
    mean[zero] = mean_heading_rad(line, nominal_m, half_m) - first.gyro_rad.value_or(0);
    return mean;
}

Belief
prior(const DrivenLine& line, const Epoch& first, double nominal_m, const PlaceModel& model) {
    Vector sd;
    sd << prior_lead_sd_m, model.scale_sd, prior_lane_sd_m, prior_oneway_sd_m, model.latency_sd_s,
        first.fix_sd_m, first.fix_sd_m, prior_zero_sd_rad;
    return {prior_mean(line, first, nominal_m, model.heading_half_m), sd.cwiseAbs2().asDiagonal()};
}

/// From one epoch to the next: x' = f x + noise.
struct Step {
    Square f;
    Vector noise; ///< variances
};

Step step_between(const Epoch& from,
                  const Epoch& to,
                  const DrivenPlace& here,
                  const DrivenPlace& there) {
    const double gone_m = to.travel_m - from.travel_m;
    const double took_s = std::abs(to.t_s - from.t_s);
    const double turn_rad = there.turned_rad[0] - here.turned_rad[0];
    const double oneway_rad = there.turned_rad[1] - here.turned_rad[1];
    const double kept = std::exp(-took_s / slow_error_s);
    Step step{Square::Identity(), Vector::Zero()};
    step.f(lead, scale) = gone_m;
    step.f(lead, lane) = -turn_rad;
    step.f(lead, lane_oneway) = -oneway_rad;
    step.f(east, east) = step.f(north, north) = kept;
    step.noise[lead] = (to.measured ? lead_walk : lead_walk_unmeasured) * gone_m +
                       lead_walk_turning * std::abs(turn_rad + oneway_rad) + 1e-6;
    step.noise[scale] = scale_walk * gone_m;
    step.noise[lane] = step.noise[lane_oneway] = lane_walk * gone_m;
    step.noise[latency] = latency_walk * took_s;
    step.noise[east] = step.noise[north] = (1 - kept * kept) * to.fix_sd_m * to.fix_sd_m;
    step.noise[zero] = zero_walk * took_s + to.heading_variance;
    return step;
}

Belief predicted(const Belief& belief, const Step& step) {
    Belief next{step.f * belief.mean, step.f * belief.variance * step.f.transpose()};
    next.variance.diagonal() += step.noise;
    return next;
}

/// Takes in a measurement h x + noise that stands `off` from what was expected; the less, the more
/// incredible it is.
template <int Size>
Belief updated(const Belief& belief,
               const Eigen::Matrix<double, Size, states>& h,
               const Eigen::Matrix<double, Size, 1>& off,
               Eigen::Matrix<double, Size, Size> noise) {
    const Eigen::Matrix<double, states, Size> cross = belief.variance * h.transpose();
    Eigen::Matrix<double, Size, Size> spread = h * cross + noise;
    const double sds = off.dot(spread.llt().solve(off));
    if (sds > Size * credible) {
        noise += (sds / (Size * credible) - 1) * spread;
        spread = h * cross + noise;
    }
    const Eigen::Matrix<double, states, Size> gain =
        spread.llt().solve(cross.transpose()).transpose();
    Belief next{belief.mean + gain * off, belief.variance - gain * cross.transpose()};
    next.variance = (next.variance + next.variance.transpose()).eval() / 2;
    return next;
}

Belief with_fix(const Belief& belief,
                const Epoch& epoch,
                const DrivenPlace& place,
                double nominal_m,
                double gone_m) {
    const Eigen::Vector2d ahead{place.ahead.east_m, place.ahead.north_m};
    const Eigen::Vector2d right{ahead.y(), -ahead.x()};
    Eigen::Matrix<double, 2, states> h = Eigen::Matrix<double, 2, states>::Zero();
    h.col(lead) = ahead;
    h.col(place.lane == LaneKind::two_way ? lane : lane_oneway) = right;
    h.col(latency) = -epoch.speed_mps * ahead;
    h(0, east) = h(1, north) = 1;
    const Eigen::Vector2d seen{epoch.fix->east_m - place.at.east_m,
                               epoch.fix->north_m - place.at.north_m};
    const double nominal_lead_m = nominal_m - epoch.travel_m;
    const Eigen::Vector2d off = seen + nominal_lead_m * ahead - h * belief.mean;
    const double across =
        map_sd_m * map_sd_m * map_length_m / std::clamp(gone_m, 1.0, map_length_m);
    const Eigen::Matrix2d noise = quick_error_m * quick_error_m * Eigen::Matrix2d::Identity() +
                                  across * right * right.transpose();
    return updated<2>(belief, h, off, noise);
}

Belief with_heading(const Belief& belief,
                    const DrivenLine& line,
                    const Epoch& epoch,
                    double nominal_m,
                    double gone_m,
                    double half_m) {
    constexpr double step_m = 1;
    const double before_rad = mean_heading_rad(line, nominal_m - step_m, half_m);
    const double after_rad = mean_heading_rad(line, nominal_m + step_m, half_m);
    const double bend_per_m = (after_rad - before_rad) / (2 * step_m);
    Eigen::Matrix<double, 1, states> h = Eigen::Matrix<double, 1, states>::Zero();
    h(lead) = -bend_per_m;
    h(zero) = 1;
    const double expected_rad = (before_rad + after_rad) / 2 +
                                bend_per_m * (epoch.travel_m + belief.mean[lead] - nominal_m);
    const Eigen::Matrix<double, 1, 1> off{
        std::remainder(expected_rad - *epoch.gyro_rad - belief.mean[zero], 2 * std::numbers::pi)};
    const double alike = std::max(1.0, 2 * half_m / std::max(gone_m, 0.5));
    const double bend_sd_rad = bend_per_m * bend_sd_m;
    const Eigen::Matrix<double, 1, 1> noise{
        alike * (heading_sd_rad * heading_sd_rad + bend_sd_rad * bend_sd_rad)};
    return updated<1>(belief, h, off, noise);
}

/// One of the smoother's rounds, linear about `nominal_m`.
std::vector<Belief> smoothed(const DrivenLine& line,
                             const std::vector<Epoch>& epochs,
                             const std::vector<double>& nominal_m,
                             const PlaceModel& model) {
    std::vector<DrivenPlace> places;
    places.reserve(epochs.size());
    for (const double driven_m : nominal_m) {
        places.push_back(place_at(line, driven_m));
    }
    std::vector<Belief> beliefs;
    beliefs.reserve(epochs.size());
    for (std::size_t k = 0; k < epochs.size(); ++k) {
        const auto& epoch = epochs[k];
        auto belief = k == 0
                          ? prior(line, epoch, nominal_m[0], model)
                          : predicted(beliefs.back(),
                                      step_between(epochs[k - 1], epoch, places[k - 1], places[k]));
        const double gone_m =
            k == 0 ? map_length_m : std::max(0.0, epoch.travel_m - epochs[k - 1].travel_m);
        if (epoch.fix) {
            belief = with_fix(belief, epoch, places[k], nominal_m[k], gone_m);
        }
        if (epoch.gyro_rad) {
            belief = with_heading(belief, line, epoch, nominal_m[k], gone_m, model.heading_half_m);
        }
        beliefs.push_back(belief);
    }
    for (auto k = epochs.size() - 1; k-- > 0;) {
        const auto step = step_between(epochs[k], epochs[k + 1], places[k], places[k + 1]);
        auto& belief = beliefs[k];
        const auto next = predicted(belief, step);
        const Square gain = next.variance.ldlt().solve(step.f * belief.variance).transpose();
        belief.mean += gain * (beliefs[k + 1].mean - next.mean);
        belief.variance += gain * (beliefs[k + 1].variance - next.variance) * gain.transpose();
    }
    return beliefs;
}

} // namespace

std::vector<Placed> smoothed_places(const DrivenLine& line,
                                    const std::vector<Epoch>& epochs,
                                    std::vector<double> nominal_m,
                                    const PlaceModel& model) {
    std::vector<Placed> placed(epochs.size());
    for (int round = 0; round < rounds; ++round) {
        const auto beliefs = smoothed(line, epochs, nominal_m, model);
        for (std::size_t k = 0; k < epochs.size(); ++k) {
            const double driven_m = epochs[k].travel_m + beliefs[k].mean[lead];
            nominal_m[k] = k == 0 ? driven_m : std::max(nominal_m[k - 1], driven_m);
            placed[k] = {nominal_m[k], std::sqrt(std::max(0.0, beliefs[k].variance(lead, lead)))};
        }
    }
    return placed;
}

} // namespace macadam
