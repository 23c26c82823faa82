#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>

/// Road-independent parts of the position smoother: state propagation between epochs and
/// measurement updates. Source: position_smoother.hpp.
namespace macadam::place_filter {

/// Trips with positions alone cannot observe the last two.
enum State : int { lead, scale, lane, lane_oneway, east, north, latency, zero };
inline constexpr int states_of_positions = 6;
inline constexpr int all_states = 8;

template <int States>
using Vector = Eigen::Matrix<double, States, 1>;
template <int States>
using Square = Eigen::Matrix<double, States, States>;

inline constexpr double credible = 9; // squared sds beyond which a measurement counts less

/// State transition between epochs: x' = f x + noise, where f has 1 on its diagonal except for the
/// slow error, and off-diagonal entries only in the row of the lead.
struct Step {
    double scale_gain; ///< of the lead, per unit of scale
    double lane_gain;  ///< of the lead, per metre of lane offset
    double oneway_gain;
    double kept; ///< of the slow error
};

/// A processed measurement: h x + noise with innovation `off`.
template <int States>
struct Taken {
    Vector<States> h;
    Vector<States> gain;
    double off;
    double weight; ///< 1 / variance of off
};

/// Kalman filter with mean and variance. The variance stays symmetric to the last bit, because it
/// is only changed by products that commute.
template <int States>
class Forward {
public:
    Forward(const Vector<States>& mean, const Vector<States>& sd)
        : mean_{mean}, variance_{sd.cwiseAbs2().asDiagonal()} {}

    const Vector<States>& mean() const { return mean_; }
    Vector<States> lead_spread() const { return variance_.col(lead); }

    void go(const Step& step, const Vector<States>& noise) {
        const auto gained = [&](const auto& column) {
            return step.scale_gain * column[scale] + step.lane_gain * column[lane] +
                   step.oneway_gain * column[lane_oneway];
        };
        mean_[lead] += gained(mean_);
        Vector<States> spread = variance_.col(lead) + step.scale_gain * variance_.col(scale) +
                                step.lane_gain * variance_.col(lane) +
                                step.oneway_gain * variance_.col(lane_oneway);
        spread[lead] += gained(spread);
        variance_.col(lead) = spread;
        variance_.row(lead) = spread.transpose();
        for (const int error : {east, north}) {
            mean_[error] *= step.kept;
            variance_.col(error) *= step.kept;
            variance_.row(error) *= step.kept;
        }
        variance_.diagonal() += noise;
    }

    /// Updates with a measurement, down-weighted as its innovation exceeds the credible range.
    Taken<States> take(const Vector<States>& h, double off, double noise) {
        const Vector<States> cross = variance_.lazyProduct(h);
        const double spread = h.dot(cross) + noise;
        const double inflated = spread * std::max(1.0, off * off / spread / credible);
        return learnt(h, cross, off, inflated);
    }

    /// Updates with two measurements of independent noise, down-weighted jointly.
    std::array<Taken<States>, 2> take(const std::array<Vector<States>, 2>& h,
                                      const std::array<double, 2>& off,
                                      const std::array<double, 2>& noise) {
        const Vector<States> cross = variance_.lazyProduct(h[0]);
        const Vector<States> cross_b = variance_.lazyProduct(h[1]);
        const double spread = h[0].dot(cross) + noise[0];
        const double mixed = h[0].dot(cross_b);
        const double spread_b = h[1].dot(cross_b) + noise[1];
        const double sds =
            (spread_b * off[0] * off[0] - 2 * mixed * off[0] * off[1] + spread * off[1] * off[1]) /
            (spread * spread_b - mixed * mixed);
        const double inflation = std::max(1.0, sds / (2 * credible));
        // Noise that is a share of the spread is correlated between the two: only the part of the
        // second that the first does not predict is new information.
        const double alike = (inflation - 1) * mixed;
        const double share = alike / (noise[0] + (inflation - 1) * spread);
        const double rest = noise[1] + (inflation - 1) * spread_b - share * alike;
        const auto first = learnt(h[0], cross, off[0], inflation * spread);
        const Vector<States> news = h[1] - share * h[0];
        const Vector<States> cross_news = cross_b - share * cross - first.gain * cross.dot(news);
        const double off_news = off[1] - share * off[0] - news.dot(first.gain) * off[0];
        return {first, learnt(news, cross_news, off_news, news.dot(cross_news) + rest)};
    }

private:
    Taken<States>
    learnt(const Vector<States>& h, const Vector<States>& cross, double off, double spread) {
        const double weight = 1 / spread;
        const Vector<States> gain = weight * cross;
        mean_ += off * gain;
        for (int i = 0; i < States; ++i) {
            variance_.col(i) -= weight * (cross[i] * cross);
        }
        return {h, gain, off, weight};
    }

    Vector<States> mean_;
    Square<States> variance_;
};

/// Backward recursion over later measurements: x = mean - variance * score, with variance variance
/// - variance * information * variance.
template <int States>
Vector<States> score_before(const Taken<States>& taken, const Vector<States>& after) {
    return after - taken.h * (taken.gain.dot(after) + taken.weight * taken.off);
}

template <int States>
Vector<States> score_before(const Step& step, Vector<States> score) {
    score[scale] += step.scale_gain * score[lead];
    score[lane] += step.lane_gain * score[lead];
    score[lane_oneway] += step.oneway_gain * score[lead];
    score[east] *= step.kept;
    score[north] *= step.kept;
    return score;
}

template <int States>
Square<States> information_before(const Taken<States>& taken, Square<States> after) {
    const Vector<States> informed = after.lazyProduct(taken.gain);
    const double inner = taken.weight + taken.gain.dot(informed);
    const Vector<States> mixed = informed - inner / 2 * taken.h;
    for (int i = 0; i < States; ++i) {
        after.col(i) -= taken.h[i] * mixed + mixed[i] * taken.h;
    }
    return after;
}

template <int States>
Square<States> information_before(const Step& step, Square<States> information) {
    const Vector<States> of_lead = information.col(lead);
    information.col(scale) += step.scale_gain * of_lead;
    information.col(lane) += step.lane_gain * of_lead;
    information.col(lane_oneway) += step.oneway_gain * of_lead;
    const Vector<States> row = information.row(lead).transpose();
    information.row(scale) += step.scale_gain * row.transpose();
    information.row(lane) += step.lane_gain * row.transpose();
    information.row(lane_oneway) += step.oneway_gain * row.transpose();
    for (const int error : {east, north}) {
        information.col(error) *= step.kept;
        information.row(error) *= step.kept;
    }
    // Asymmetric rounding errors would grow from step to step.
    for (int i = 0; i < States; ++i) {
        for (int j = 0; j < i; ++j) {
            information(j, i) = information(i, j);
        }
    }
    return information;
}

} // namespace macadam::place_filter
