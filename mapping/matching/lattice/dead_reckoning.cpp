#include "mapping/matching/lattice/dead_reckoning.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace macadam {
namespace {

enum State : int { east, north, along, across, error_east, error_north, states };

using Vector = Eigen::Matrix<double, states, 1>;
using Square = Eigen::Matrix<double, states, states>;

constexpr double far_m = 100; // between fixes: closer fixes identify the path by themselves
constexpr double worst_sd_m = 100;
constexpr double min_step_s = 0.95;
constexpr double draw_step_m = 5;      // usual chord of the reconstructed path
constexpr double max_draw_steps = 200; // longer chords for gaps without any sensor
constexpr double min_moment_s = 0.5;   // no car covers the sampling distance faster
constexpr double slow_error_s = 30;
constexpr double quick_error_m = 1;
constexpr double credible = 18;         // squared sds beyond which a fix counts less
constexpr double size_walk = 1e-9;      // per m
constexpr double slip_variance = 1e-3;  // m2 per m, along and across
constexpr double bias_alike_s = 30;     // correlation time of the residual gyro bias
constexpr double silence_variance = 10; // of the heading after a gap: unconstrained

/// A time with the step by wheels and gyro since the previous one.
struct Moment {
    double t_s;
    double travel_m;
    PointEn drawn_m;         ///< rotated and scaled by the gyro's zero and the wheels
    double heading_variance; ///< gained during the step
    const Position* fix;     ///< nullptr between fixes
};

bool is_far(const Position& a, const Position& b, const MatchObservations& positions) {
    return b.travel_m - a.travel_m > far_m &&
           std::isfinite(turned(*positions.heading, a.t_s, b.t_s).sd_rad);
}

PointEn
drawn_between(const Heading& heading, const Odometer& odometer, double from_m, double to_m) {
    PointEn sum{0, 0};
    const auto steps =
        static_cast<int>(std::clamp(std::ceil((to_m - from_m) / draw_step_m), 1.0, max_draw_steps));
    const double step_m = (to_m - from_m) / steps;
    for (int i = 0; i < steps; ++i) {
        const double rad = turned_at(heading, odometer.t_s(from_m + (i + 0.5) * step_m));
        sum = {sum.east_m + step_m * std::cos(rad), sum.north_m + step_m * std::sin(rad)};
    }
    return sum;
}

double strayed_variance(const Heading& heading, double from_s, double to_s) {
    const auto turn = turned(heading, from_s, to_s);
    const double bias = heading.bias_sd_radps;
    return std::isinf(turn.sd_rad)
               ? silence_variance
               : turn.sd_rad * turn.sd_rad + bias_alike_s * bias * bias * (to_s - from_s);
}

std::vector<Moment>
moments_of(const MatchObservations& positions, const Odometer& odometer, double spacing_m) {
    std::vector<Moment> moments;
    const auto add = [&](double t_s, double travel_m, const Position* fix) {
        const bool first = moments.empty();
        moments.push_back(
            {t_s,
             travel_m,
             first ? PointEn{0, 0}
                   : drawn_between(*positions.heading, odometer, moments.back().travel_m, travel_m),
             first ? 0 : strayed_variance(*positions.heading, moments.back().t_s, t_s),
             fix});
    };
    for (const auto& position : positions.all) {
        const auto* const before = moments.empty() ? nullptr : moments.back().fix;
        if (before != nullptr && position.t_s - before->t_s < min_step_s) {
            continue;
        }
        if (before != nullptr && is_far(*before, position, positions)) {
            const double gap_m = position.travel_m - before->travel_m;
            const double steps =
                std::ceil(std::min(gap_m / spacing_m, (position.t_s - before->t_s) / min_moment_s));
            for (double i = 1; i < steps; ++i) {
                const double travel_m = before->travel_m + gap_m * i / steps;
                add(odometer.t_s(travel_m), travel_m, nullptr);
            }
        }
        add(position.t_s, position.travel_m, &position);
    }
    return moments;
}

struct StateEstimate {
    Vector mean;
    Square variance;
};

StateEstimate prior(const Moment& first) {
    const double sd_m = static_cast<double>(first.fix->own_sd_m);
    StateEstimate estimate{Vector::Zero(), Square::Zero()};
    estimate.mean[east] = first.fix->at.east_m;
    estimate.mean[north] = first.fix->at.north_m;
    estimate.variance.diagonal() << 4 * sd_m * sd_m, 4 * sd_m * sd_m, 1, 1, sd_m * sd_m,
        sd_m * sd_m;
    return estimate;
}

Square step_of(const Moment& to, double kept) {
    Square f = Square::Identity();
    f(east, along) = to.drawn_m.east_m;
    f(east, across) = -to.drawn_m.north_m;
    f(north, along) = to.drawn_m.north_m;
    f(north, across) = to.drawn_m.east_m;
    f(error_east, error_east) = f(error_north, error_north) = kept;
    return f;
}

double kept_of(const Moment& from, const Moment& to) {
    return std::exp(-std::abs(to.t_s - from.t_s) / slow_error_s);
}

StateEstimate
predicted(const StateEstimate& estimate, const Moment& from, const Moment& to, double sd_m) {
    const double kept = kept_of(from, to);
    const double gone_m = to.travel_m - from.travel_m;
    const auto f = step_of(to, kept);
    StateEstimate next{f * estimate.mean, f * estimate.variance * f.transpose()};
    next.variance(east, east) += slip_variance * gone_m + 1e-6;
    next.variance(north, north) += slip_variance * gone_m + 1e-6;
    next.variance(along, along) += to.heading_variance + size_walk * gone_m;
    next.variance(across, across) += to.heading_variance + size_walk * gone_m;
    next.variance(error_east, error_east) += (1 - kept * kept) * sd_m * sd_m;
    next.variance(error_north, error_north) += (1 - kept * kept) * sd_m * sd_m;
    return next;
}

StateEstimate with_fix(const StateEstimate& estimate, const Position& fix) {
    Eigen::Matrix<double, 2, states> h = Eigen::Matrix<double, 2, states>::Zero();
    h(0, east) = h(1, north) = h(0, error_east) = h(1, error_north) = 1;
    const Eigen::Vector2d off = Eigen::Vector2d{fix.at.east_m, fix.at.north_m} - h * estimate.mean;
    const Eigen::Matrix<double, states, 2> cross = estimate.variance * h.transpose();
    Eigen::Matrix2d spread =
        h * cross + quick_error_m * quick_error_m * Eigen::Matrix2d::Identity();
    spread *= std::max(1.0, off.dot(spread.llt().solve(off)) / credible);
    const Eigen::Matrix<double, states, 2> gain = spread.llt().solve(cross.transpose()).transpose();
    StateEstimate next{estimate.mean + gain * off, estimate.variance - gain * cross.transpose()};
    next.variance = (next.variance + next.variance.transpose()).eval() / 2;
    return next;
}

std::vector<StateEstimate> smoothed(const std::vector<Moment>& moments) {
    std::vector<StateEstimate> estimates;
    estimates.reserve(moments.size());
    const double sd_m = static_cast<double>(moments.front().fix->own_sd_m);
    for (std::size_t k = 0; k < moments.size(); ++k) {
        auto estimate = k == 0 ? prior(moments[0])
                               : predicted(estimates.back(), moments[k - 1], moments[k], sd_m);
        estimates.push_back(moments[k].fix != nullptr ? with_fix(estimate, *moments[k].fix)
                                                      : estimate);
    }
    for (auto k = moments.size() - 1; k-- > 0;) {
        auto& estimate = estimates[k];
        const auto next = predicted(estimate, moments[k], moments[k + 1], sd_m);
        const auto f = step_of(moments[k + 1], kept_of(moments[k], moments[k + 1]));
        const Square gain = next.variance.ldlt().solve(f * estimate.variance).transpose();
        estimate.mean += gain * (estimates[k + 1].mean - next.mean);
        estimate.variance += gain * (estimates[k + 1].variance - next.variance) * gain.transpose();
    }
    return estimates;
}

} // namespace

std::vector<DeadReckoned>
dead_reckoned(const MatchObservations& positions, const Odometer& odometer, double spacing_m) {
    const auto& all = positions.all;
    bool wanted = false;
    for (std::size_t i = 1; i < all.size(); ++i) {
        wanted = wanted || is_far(all[i - 1], all[i], positions);
    }
    if (!wanted || !positions.odometer || positions.heading->turned_rad.empty()) {
        return {};
    }
    const auto moments = moments_of(positions, odometer, spacing_m);
    const auto estimates = smoothed(moments);
    std::vector<DeadReckoned> places;
    for (std::size_t k = 0; k < moments.size(); ++k) {
        const auto& x = estimates[k].mean;
        const auto& p = estimates[k].variance;
        const double sd_m = std::sqrt(std::max(0.0, (p(east, east) + p(north, north)) / 2));
        if (moments[k].fix != nullptr || !(sd_m < worst_sd_m)) {
            continue;
        }
        const double rad =
            std::atan2(x[across], x[along]) + turned_at(*positions.heading, moments[k].t_s);
        places.push_back({moments[k].t_s,
                          moments[k].travel_m,
                          {x[east], x[north]},
                          sd_m,
                          static_cast<float>(std::numbers::pi / 2 - rad)});
    }
    return places;
}

} // namespace macadam
