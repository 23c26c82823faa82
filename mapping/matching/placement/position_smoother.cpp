#include "mapping/matching/placement/position_smoother.hpp"

#include "mapping/matching/placement/position_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace macadam {
namespace {

using namespace place_filter;

constexpr int rounds = 3; // by then positions are stable to centimetres
constexpr double settled_m = 0.5;

constexpr double prior_lead_sd_m = 30;
constexpr double prior_lane_sd_m = 3; // to either side of the road
constexpr double prior_oneway_sd_m = 2;
constexpr double prior_zero_sd_rad = 1;

constexpr double lead_walk = 0.001; // m2 per m: bends of the map against the car's, 0.3 m in 100 m
constexpr double lead_walk_turning = 0.5;  // m2 per rad: drivers cut corners differently
constexpr double lead_walk_unmeasured = 2; // m2 per m: travel derived from positions
constexpr double lane_walk = 5e-4;         // m2 per m: 0.5 m in 500 m
constexpr double scale_walk = 1e-11;       // per m: 1e-3 in 100 km
constexpr double latency_walk = 1e-7;      // s2 per s: 0.02 s in an hour
constexpr double zero_walk = 1e-6;         // rad2 per s, in addition to the gyro's own

constexpr double slow_error_s = 30;     // correlation time of a receiver's error
constexpr double quick_error_m = 0.7;   // white part, independent at every fix
constexpr double map_sd_m = 0.7;        // of the line across the road
constexpr double map_length_m = 100;    // correlation length of the map error
constexpr double heading_sd_rad = 0.07; // of the line against the car
constexpr double bend_sd_m = 1.5;       // of the position of a bend along the line

/// Motion between epochs, independent of the linearisation.
struct Motion {
    double gone_m; ///< since the previous epoch
    double took_s;
    double kept; ///< of the slow error
};

std::vector<Motion> motions_of(const std::vector<Epoch>& epochs) {
    std::vector<Motion> motions(epochs.size(), {map_length_m, 0, 1});
    for (std::size_t k = 1; k < epochs.size(); ++k) {
        const double took_s = std::abs(epochs[k].t_s - epochs[k - 1].t_s);
        motions[k] = {std::max(0.0, epochs[k].travel_m - epochs[k - 1].travel_m),
                      took_s,
                      took_s == motions[k - 1].took_s ? motions[k - 1].kept
                                                      : std::exp(-took_s / slow_error_s)};
    }
    return motions;
}

/// Filter results of an epoch for the backward pass.
template <int States>
struct Passed {
    Step step;             ///< from the previous epoch
    Vector<States> spread; ///< covariance of the lead with each state, before the measurements
    double lead_m;
    int count;
    std::array<Taken<States>, 3>
        taken; ///< as many as counted: the fix in two parts, then the heading
};

template <int States>
class Smoother {
public:
    Smoother(const SmoothedPath& line, const std::vector<Epoch>& epochs, const PositionModel& model)
        : line_{line}, epochs_{epochs}, model_{model}, motions_{motions_of(epochs)},
          passed_(epochs.size()) {}

    std::vector<PathPosition> places(std::vector<double> nominal_m) && {
        for (int round = 0; round < rounds; ++round) {
            forward(nominal_m);
            auto driven_m = backward();
            double moved_m = 0;
            for (std::size_t k = 0; k < driven_m.size(); ++k) {
                driven_m[k] = k == 0 ? driven_m[k] : std::max(driven_m[k - 1], driven_m[k]);
                moved_m = std::max(moved_m, std::abs(driven_m[k] - nominal_m[k]));
            }
            nominal_m = std::move(driven_m);
            if (moved_m < settled_m) {
                break;
            }
        }
        return with_sds(nominal_m);
    }

private:
    Forward<States> prior(double nominal_m) const {
        const auto& first = epochs_.front();
        Vector<all_states> sd;
        sd << prior_lead_sd_m, model_.scale_sd, prior_lane_sd_m, prior_oneway_sd_m, first.fix_sd_m,
            first.fix_sd_m, model_.latency_sd_s, prior_zero_sd_rad;
        Vector<all_states> mean = Vector<all_states>::Zero();
        mean[lead] = nominal_m - first.travel_m;
        mean[zero] =
            mean_heading_rad(line_, nominal_m, model_.heading_half_m) - first.gyro_rad.value_or(0);
        return {mean.template head<States>(), sd.template head<States>()};
    }

    static Step step_between(const Motion& motion, const PathPose& here, const PathPose& there) {
        return {motion.gone_m,
                here.turned_rad[0] - there.turned_rad[0],
                here.turned_rad[1] - there.turned_rad[1],
                motion.kept};
    }

    /// Returns the process noise variances of a step.
    static Vector<States> noise_of(const Step& step, const Motion& motion, const Epoch& to) {
        const double turn_rad = std::abs(step.lane_gain + step.oneway_gain);
        const double walk = to.measured ? lead_walk : lead_walk_unmeasured;
        const double error = (1 - step.kept * step.kept) * to.fix_sd_m * to.fix_sd_m;
        Vector<States> noise;
        noise[lead] = walk * motion.gone_m + lead_walk_turning * turn_rad + 1e-6;
        noise[scale] = scale_walk * motion.gone_m;
        noise[lane] = noise[lane_oneway] = lane_walk * motion.gone_m;
        noise[east] = noise[north] = error;
        if constexpr (States == all_states) {
            noise[latency] = latency_walk * motion.took_s;
            noise[zero] = zero_walk * motion.took_s + to.heading_variance;
        }
        return noise;
    }

    void forward(const std::vector<double>& nominal_m) {
        auto estimate = prior(nominal_m[0]);
        auto place = place_at(line_, nominal_m[0]);
        for (std::size_t k = 0; k < epochs_.size(); ++k) {
            auto& passed = passed_[k];
            passed.count = 0;
            if (k > 0) {
                const auto before = place;
                place = place_at(line_, nominal_m[k]);
                passed.step = step_between(motions_[k], before, place);
                estimate.go(passed.step, noise_of(passed.step, motions_[k], epochs_[k]));
            }
            passed.spread = estimate.lead_spread();
            passed.lead_m = estimate.mean()[lead];
            if (epochs_[k].fix) {
                const auto taken = take_fix(estimate, k, place, nominal_m[k]);
                passed.taken[0] = taken[0];
                passed.taken[1] = taken[1];
                passed.count = 2;
            }
            if constexpr (States == all_states) {
                if (epochs_[k].gyro_rad) {
                    passed.taken[static_cast<std::size_t>(passed.count++)] =
                        take_heading(estimate, k, nominal_m[k]);
                }
            }
        }
    }

    std::array<Taken<States>, 2> take_fix(Forward<States>& estimate,
                                          std::size_t k,
                                          const PathPose& place,
                                          double nominal_m) const {
        const auto& epoch = epochs_[k];
        const PointEn ahead = place.ahead;
        const PointEn right{ahead.north_m, -ahead.east_m};
        Vector<States> along = Vector<States>::Zero();
        along[lead] = 1;
        along[east] = ahead.east_m;
        along[north] = ahead.north_m;
        if constexpr (States == all_states) {
            along[latency] = -epoch.speed_mps;
        }
        Vector<States> across = Vector<States>::Zero();
        across[place.lane == LaneKind::two_way ? lane : lane_oneway] = 1;
        across[east] = right.east_m;
        across[north] = right.north_m;
        const PointEn seen{epoch.fix->east_m - place.at.east_m,
                           epoch.fix->north_m - place.at.north_m};
        const double nominal_lead_m = nominal_m - epoch.travel_m;
        const double off_along_m = seen.east_m * ahead.east_m + seen.north_m * ahead.north_m +
                                   nominal_lead_m - along.dot(estimate.mean());
        const double off_across_m =
            seen.east_m * right.east_m + seen.north_m * right.north_m - across.dot(estimate.mean());
        constexpr double quick = quick_error_m * quick_error_m;
        const double map =
            map_sd_m * map_sd_m * map_length_m / std::clamp(motions_[k].gone_m, 1.0, map_length_m);
        return estimate.take({along, across}, {off_along_m, off_across_m}, {quick, quick + map});
    }

    Taken<States> take_heading(Forward<States>& estimate, std::size_t k, double nominal_m) const {
        constexpr double step_m = 1;
        const auto& epoch = epochs_[k];
        const double half_m = model_.heading_half_m;
        const double before_rad = mean_heading_rad(line_, nominal_m - step_m, half_m);
        const double after_rad = mean_heading_rad(line_, nominal_m + step_m, half_m);
        const double bend_per_m = (after_rad - before_rad) / (2 * step_m);
        Vector<States> h = Vector<States>::Zero();
        h[lead] = -bend_per_m;
        h[zero] = 1;
        const double expected_rad =
            (before_rad + after_rad) / 2 +
            bend_per_m * (epoch.travel_m + estimate.mean()[lead] - nominal_m);
        const double off_rad = std::remainder(
            expected_rad - *epoch.gyro_rad - estimate.mean()[zero], 2 * std::numbers::pi);
        const double alike = std::max(1.0, 2 * half_m / std::max(motions_[k].gone_m, 0.5));
        const double bend_sd_rad = bend_per_m * bend_sd_m;
        return estimate.take(
            h, off_rad, alike * (heading_sd_rad * heading_sd_rad + bend_sd_rad * bend_sd_rad));
    }

    /// Returns the smoothed positions, linearised about the filter's input.
    std::vector<double> backward() const {
        std::vector<double> driven_m(epochs_.size());
        Vector<States> score = Vector<States>::Zero();
        for (auto k = epochs_.size(); k-- > 0;) {
            const auto& here = passed_[k];
            for (auto i = here.count; i-- > 0;) {
                score = score_before(here.taken[static_cast<std::size_t>(i)], score);
            }
            driven_m[k] = epochs_[k].travel_m + here.lead_m - here.spread.dot(score);
            score = score_before(here.step, score);
        }
        return driven_m;
    }

    std::vector<PathPosition> with_sds(const std::vector<double>& driven_m) const {
        std::vector<PathPosition> placed(epochs_.size());
        Square<States> information = Square<States>::Zero();
        for (auto k = epochs_.size(); k-- > 0;) {
            const auto& here = passed_[k];
            for (auto i = here.count; i-- > 0;) {
                information =
                    information_before(here.taken[static_cast<std::size_t>(i)], information);
            }
            const Vector<States> known = information.lazyProduct(here.spread);
            const double variance = here.spread[lead] - here.spread.dot(known);
            placed[k] = {driven_m[k], std::sqrt(std::max(0.0, variance))};
            information = information_before(here.step, information);
        }
        return placed;
    }

    const SmoothedPath& line_;
    const std::vector<Epoch>& epochs_;
    const PositionModel& model_;
    std::vector<Motion> motions_;
    std::vector<Passed<States>> passed_;
};

} // namespace

std::vector<PathPosition> smoothed_places(const SmoothedPath& line,
                                          const std::vector<Epoch>& epochs,
                                          std::vector<double> nominal_m,
                                          const PositionModel& model) {
    const bool gyro =
        std::ranges::any_of(epochs, [](const Epoch& epoch) { return epoch.gyro_rad.has_value(); });
    return gyro || model.latency_sd_s > 0
               ? Smoother<all_states>{line, epochs, model}.places(std::move(nominal_m))
               : Smoother<states_of_positions>{line, epochs, model}.places(std::move(nominal_m));
}

} // namespace macadam
