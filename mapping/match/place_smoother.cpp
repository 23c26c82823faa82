#include "mapping/match/place_smoother.hpp"

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace macadam {
namespace {

enum State : int { lead, scale, lane, lane_oneway, latency, east, north, zero, states };

using Vector = Eigen::Matrix<double, states, 1>;
using Square = Eigen::Matrix<double, states, states>;

constexpr int rounds = 3; // by then the places stand still to centimetres
constexpr double settled_m = 0.5;

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

/// From one epoch to the next: x' = f x + noise, where f is 1 on its diagonal but for the slow
/// error, and otherwise only what the lead gains.
struct Step {
    double scale_gain; ///< of the lead, per unit of the scale ...
    double lane_gain;  ///< ... and per metre of the lanes
    double oneway_gain;
    double kept;  ///< of the slow error
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
    Step step{gone_m, -turn_rad, -oneway_rad, kept, Vector::Zero()};
    step.noise[lead] = (to.measured ? lead_walk : lead_walk_unmeasured) * gone_m +
                       lead_walk_turning * std::abs(turn_rad + oneway_rad) + 1e-6;
    step.noise[scale] = scale_walk * gone_m;
    step.noise[lane] = step.noise[lane_oneway] = lane_walk * gone_m;
    step.noise[latency] = latency_walk * took_s;
    step.noise[east] = step.noise[north] = (1 - kept * kept) * to.fix_sd_m * to.fix_sd_m;
    step.noise[zero] = zero_walk * took_s + to.heading_variance;
    return step;
}

/// f * x
Vector stepped(const Step& step, Vector x) {
    x[lead] +=
        step.scale_gain * x[scale] + step.lane_gain * x[lane] + step.oneway_gain * x[lane_oneway];
    x[east] *= step.kept;
    x[north] *= step.kept;
    return x;
}

/// f' * x
Vector stepped_back(const Step& step, Vector x) {
    x[scale] += step.scale_gain * x[lead];
    x[lane] += step.lane_gain * x[lead];
    x[lane_oneway] += step.oneway_gain * x[lead];
    x[east] *= step.kept;
    x[north] *= step.kept;
    return x;
}

/// f * p * f', column by column and then row by row.
template <typename Apply>
Square on_both_sides(const Square& p, const Apply& apply) {
    Square half;
    for (int i = 0; i < states; ++i) {
        half.col(i) = apply(p.col(i));
    }
    Square whole;
    for (int i = 0; i < states; ++i) {
        whole.col(i) = apply(half.row(i).transpose());
    }
    return whole;
}

Belief predicted(const Belief& belief, const Step& step) {
    const auto apply = [&](const Vector& x) { return stepped(step, x); };
    Belief next{apply(belief.mean), on_both_sides(belief.variance, apply)};
    next.variance.diagonal() += step.noise;
    return next;
}

/// A measurement as the filter took it in: h x + noise stood `off` from what was expected.
template <int Size>
struct Taken {
    Eigen::Matrix<double, Size, states> h;
    Eigen::Matrix<double, Size, 1> off;
    Eigen::Matrix<double, Size, Size> weight; ///< 1 / variance of off
    Eigen::Matrix<double, states, Size> gain;
};

/// How a measurement is taken in: the more incredible it is, the less it counts.
template <int Size>
Taken<Size> taken(const Belief& belief,
                  const Eigen::Matrix<double, Size, states>& h,
                  const Eigen::Matrix<double, Size, 1>& off,
                  Eigen::Matrix<double, Size, Size> noise) {
    const Eigen::Matrix<double, states, Size> cross = belief.variance * h.transpose();
    Eigen::Matrix<double, Size, Size> spread = h * cross + noise;
    const double sds = off.dot(spread.inverse() * off);
    if (sds > Size * credible) {
        noise += (sds / (Size * credible) - 1) * spread;
        spread = h * cross + noise;
    }
    const Eigen::Matrix<double, Size, Size> weight = spread.inverse();
    return {h, off, weight, cross * weight};
}

template <int Size>
Belief updated(const Belief& belief, const Taken<Size>& taken) {
    const Eigen::Matrix<double, Size, states> cross = taken.h * belief.variance;
    Belief next{belief.mean + taken.gain * taken.off, belief.variance - taken.gain * cross};
    next.variance = (next.variance + next.variance.transpose()).eval() / 2;
    return next;
}

Taken<2> take_fix(const Belief& belief,
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
    return taken<2>(belief, h, off, noise);
}

Taken<1> take_heading(const Belief& belief,
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
    return taken<1>(belief, h, off, noise);
}

/// What the filter leaves of an epoch for the way back.
struct Passed {
    Step step;     ///< from the epoch before
    Vector spread; ///< before the measurements: of the lead with each state
    double lead_m;
    std::optional<Taken<2>> fix;
    std::optional<Taken<1>> heading; ///< taken in after the fix
};

std::vector<Passed> filtered(const DrivenLine& line,
                             const std::vector<Epoch>& epochs,
                             const std::vector<double>& nominal_m,
                             const PlaceModel& model) {
    std::vector<Passed> passed;
    passed.reserve(epochs.size());
    auto place = place_at(line, nominal_m[0]);
    auto belief = prior(line, epochs[0], nominal_m[0], model);
    for (std::size_t k = 0; k < epochs.size(); ++k) {
        const auto& epoch = epochs[k];
        Step step{};
        double gone_m = map_length_m;
        if (k > 0) {
            const auto before = place;
            place = place_at(line, nominal_m[k]);
            gone_m = std::max(0.0, epoch.travel_m - epochs[k - 1].travel_m);
            step = step_between(epochs[k - 1], epoch, before, place);
            belief = predicted(belief, step);
        }
        passed.push_back(
            {step, belief.variance.col(lead), belief.mean[lead], std::nullopt, std::nullopt});
        if (epoch.fix) {
            passed.back().fix = take_fix(belief, epoch, place, nominal_m[k], gone_m);
            belief = updated(belief, *passed.back().fix);
        }
        if (epoch.gyro_rad) {
            passed.back().heading =
                take_heading(belief, line, epoch, nominal_m[k], gone_m, model.heading_half_m);
            belief = updated(belief, *passed.back().heading);
        }
    }
    return passed;
}

/// What later measurements say of the state: x = mean - variance * score, and its spread is
/// variance - variance * information * variance.
struct Hindsight {
    Vector score = Vector::Zero();
    Square information = Square::Zero();
};

template <int Size>
Hindsight before_taking(const Hindsight& after, const Taken<Size>& taken) {
    const Eigen::Matrix<double, Size, 1> scored = taken.gain.transpose() * after.score;
    const Eigen::Matrix<double, states, Size> informed = after.information * taken.gain;
    const Eigen::Matrix<double, Size, Size> inner =
        taken.weight + taken.gain.transpose() * informed;
    const Square mixed = informed * taken.h;
    return {after.score - taken.h.transpose() * (scored + taken.weight * taken.off),
            after.information - mixed - mixed.transpose() + taken.h.transpose() * inner * taken.h};
}

Hindsight before_step(const Hindsight& after, const Step& step) {
    const auto apply = [&](const Vector& x) { return stepped_back(step, x); };
    const Square information = on_both_sides(after.information, apply);
    // Rounding errors that are not symmetric would grow from step to step.
    return {apply(after.score), (information + information.transpose()) / 2};
}

/// One of the smoother's rounds, linear about `nominal_m`: forward, and back with what came later.
std::vector<Placed> smoothed(const DrivenLine& line,
                             const std::vector<Epoch>& epochs,
                             const std::vector<double>& nominal_m,
                             const PlaceModel& model) {
    const auto passed = filtered(line, epochs, nominal_m, model);
    std::vector<Placed> placed(epochs.size());
    Hindsight hindsight;
    for (auto k = epochs.size(); k-- > 0;) {
        const auto& here = passed[k];
        if (here.heading) {
            hindsight = before_taking(hindsight, *here.heading);
        }
        if (here.fix) {
            hindsight = before_taking(hindsight, *here.fix);
        }
        const double lead_m = here.lead_m - here.spread.dot(hindsight.score);
        const double variance =
            here.spread[lead] - here.spread.dot(hindsight.information * here.spread);
        placed[k] = {epochs[k].travel_m + lead_m, std::sqrt(std::max(0.0, variance))};
        if (k > 0) {
            hindsight = before_step(hindsight, here.step);
        }
    }
    return placed;
}

} // namespace

std::vector<Placed> smoothed_places(const DrivenLine& line,
                                    const std::vector<Epoch>& epochs,
                                    std::vector<double> nominal_m,
                                    const PlaceModel& model) {
    std::vector<Placed> placed;
    for (int round = 0; round < rounds; ++round) {
        placed = smoothed(line, epochs, nominal_m, model);
        double moved_m = 0;
        for (std::size_t k = 0; k < epochs.size(); ++k) {
            auto& driven_m = placed[k].driven_m;
            driven_m = k == 0 ? driven_m : std::max(placed[k - 1].driven_m, driven_m);
            moved_m = std::max(moved_m, std::abs(driven_m - nominal_m[k]));
            nominal_m[k] = driven_m;
        }
        if (moved_m < settled_m) {
            break;
        }
    }
    return placed;
}

} // namespace macadam
