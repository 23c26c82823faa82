#include "mapping/fusion/roughness_time_series.hpp"

#include "mapping/fusion/trend_design.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double ms_per_year = 365.25 * 86400e3;
constexpr std::size_t max_steps = 3;
constexpr int min_beside = 3; // readings, and trips, required on either side of a step
constexpr int min_trips = 2;
constexpr double max_candidates = 100;
constexpr double day_years = 1 / 365.25;
constexpr double worth_a_look = 5; // nats, for the same readings without cars and trends

using Eigen::Index;
using Eigen::VectorXd;

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    const double upper = *middle;
    return values.size() % 2 == 1 ? upper : (upper + *std::max_element(values.begin(), middle)) / 2;
}

double age(const Ages& ages, Index i) {
    return ages.years[static_cast<std::size_t>(i)];
}

/// Counts the steps after a reading; an undated reading counts as the newest.
std::size_t steps_after(double years, std::span<const double> steps) {
    return static_cast<std::size_t>(
        std::ranges::count_if(steps, [&](double step) { return years > step; }));
}

/// Returns for each reading the median of its period between steps.
VectorXd medians_between(const FusionObservations& readings,
                         const Ages& ages,
                         std::span<const double> steps) {
    std::vector<std::vector<double>> of_time(steps.size() + 1);
    for (Index i = 0; i < readings.values.size(); ++i) {
        of_time[steps_after(age(ages, i), steps)].push_back(readings.values[i]);
    }
    VectorXd start(readings.values.size());
    for (Index i = 0; i < start.size(); ++i) {
        start[i] = median(of_time[steps_after(age(ages, i), steps)]);
    }
    return start;
}

/// Fit of a road with given steps.
struct Trial {
    std::vector<double> step_years; ///< youngest last, as their columns
    MeanModel mean;
    RobustFit robust;
};

struct Problem {
    const FusionObservations& readings;
    const Ages& ages;
    double level_um;
    const TailModel& tail;
    const ChangeModel& change;
};

/// Inserts a column of the error common to all cars before the columns of the steps.
MeanModel with_common(const MeanModel& mean, const VectorXd& common_sd, std::size_t steps) {
    const auto last = static_cast<Index>(steps);
    const auto first = mean.columns.cols() - last;
    MeanModel wider;
    wider.columns.resize(mean.columns.rows(), first + 1 + last);
    wider.columns << mean.columns.leftCols(first), common_sd, mean.columns.rightCols(last);
    wider.precisions.resize(first + 1 + last);
    wider.precisions << mean.precisions.head(first), 1.0, mean.precisions.tail(last);
    return wider;
}

Trial trial_of(const Problem& problem, std::vector<double> step_years) {
    auto mean = mean_model(problem.ages, problem.level_um, problem.change, step_years);
    if (const auto& common_sd = problem.readings.common_sd; common_sd.size() > 0) {
        mean = with_common(mean, common_sd, step_years.size());
    }
    auto robust = fit_student_t(problem.readings,
                                mean,
                                problem.tail,
                                medians_between(problem.readings, problem.ages, step_years));
    return {std::move(step_years), std::move(mean), std::move(robust)};
}

/// Returns the sizes of the trial's steps, in the order of step_years.
VectorXd sizes_of(const Trial& trial) {
    return trial.robust.fit.coefficients.tail(static_cast<Index>(trial.step_years.size()));
}

/// Returns the ages at which a step may lie: just before a reading after which the road may have
/// changed.
std::vector<double> candidates(const Ages& ages) {
    const double apart_years = std::max(day_years, ages.span_years / max_candidates);
    std::vector<double> dated;
    std::ranges::copy_if(
        ages.years, std::back_inserter(dated), [](double years) { return !std::isnan(years); });
    std::ranges::sort(dated);
    std::vector<double> found;
    for (std::size_t i = 0; i + 1 < dated.size(); ++i) {
        if (dated[i + 1] - dated[i] > day_years / 2 &&
            (found.empty() || dated[i] - found.back() >= apart_years)) {
            found.push_back(dated[i]);
        }
    }
    return found;
}

/// Returns true if there are enough readings on both sides of a step.
bool is_supported(const FusionObservations& readings, const Ages& ages, double step_years) {
    int beside[2] = {0, 0};
    int trips[2] = {0, 0};
    for (const auto& [first, count] : readings.trips) {
        const double years = age(ages, first);
        if (!std::isnan(years)) {
            beside[years > step_years] += static_cast<int>(count);
            ++trips[years > step_years];
        }
    }
    return std::min(beside[0], beside[1]) >= min_beside &&
           std::min(trips[0], trips[1]) >= min_trips;
}

/// Returns true if any step might gain enough likelihood, without a search.
bool is_worth_a_look(const Problem& problem) {
    const auto& readings = problem.readings;
    std::vector<std::pair<double, Index>> dated;
    for (Index i = 0; i < readings.values.size(); ++i) {
        if (!std::isnan(age(problem.ages, i))) {
            dated.emplace_back(age(problem.ages, i), i);
        }
    }
    std::ranges::sort(dated);
    const double middle = median({readings.values.begin(), readings.values.end()});
    const auto variance = [&](Index i) {
        return std::pow(readings.rest_sd[i], 2) + std::pow(readings.trip_sd, 2);
    };
    double whole = 0, whole_sum = 0;
    for (const auto& [years, i] : dated) {
        whole += 1 / variance(i);
        whole_sum += (readings.values[i] - middle) / variance(i);
    }
    double weight = 0, sum = 0;
    for (const auto& [years, i] : dated) {
        weight += 1 / variance(i);
        sum += (readings.values[i] - middle) / variance(i);
        const double rest = whole - weight;
        if (rest > 0) {
            const double apart = sum / weight - (whole_sum - sum) / rest;
            if (apart * apart * weight * rest / whole / 2 > worth_a_look) {
                return true;
            }
        }
    }
    return false;
}

/// Finds the step that would explain most, at the sds that the readings state.
std::optional<double> likeliest_step(const Problem& problem, const MeanModel& mean) {
    const auto& readings = problem.readings;
    const auto trust = full_trust(readings);
    const auto fit = fit_mean(readings, mean, trust);
    const VectorXd off =
        without_errors(readings, trust, readings.values - mean.columns * fit.coefficients);
    std::optional<double> best;
    double most = 0;
    for (const double years : candidates(problem.ages)) {
        if (!is_supported(readings, problem.ages, years)) {
            continue;
        }
        const VectorXd column = step_column(problem.ages, years);
        const VectorXd weighed = without_errors(readings, trust, column);
        const VectorXd known = mean.columns.transpose() * weighed;
        const double own = column.dot(weighed) - known.dot(fit.inverse * known);
        const double gain = own > 1e-12 ? std::pow(column.dot(off), 2) / own : 0;
        if (gain > most) {
            most = gain;
            best = years;
        }
    }
    return most / 2 > worth_a_look ? best : std::nullopt;
}

bool are_real(const Problem& problem, const Trial& trial) {
    const double min_um =
        std::max(problem.change.min_step_um, problem.change.min_step * problem.level_um);
    return sizes_of(trial).cwiseAbs().minCoeff() >= min_um;
}

/// Adds steps as long as each gains enough likelihood.
Trial with_steps(const Problem& problem) {
    auto best = trial_of(problem, {});
    const bool can_be_supported = problem.readings.values.size() >= Index{2} * min_beside;
    if (!can_be_supported || !has_slope(problem.ages) || !is_worth_a_look(problem)) {
        return best;
    }
    while (best.step_years.size() < max_steps) {
        const auto years = likeliest_step(problem, best.mean);
        if (!years) {
            break;
        }
        auto steps = best.step_years;
        steps.push_back(*years);
        auto next = trial_of(problem, std::move(steps));
        if (best.robust.misfit - next.robust.misfit < problem.change.step_nats ||
            !are_real(problem, next)) {
            break;
        }
        best = std::move(next);
    }
    return best;
}

/// Estimates the trend without its prior.
std::optional<Trend> trend_of(const Problem& problem, const Trial& trial) {
    if (problem.ages.span_years <= 1) {
        return std::nullopt;
    }
    auto mean = trial.mean;
    mean.precisions[slope_column] = 0;
    const auto fit = fit_mean(problem.readings, mean, trial.robust.trust);
    const VectorXd influence =
        influence_on(problem.readings, mean, trial.robust.trust, fit, slope_column);
    const double known = mean.precisions.dot(fit.inverse.col(slope_column).cwiseAbs2());
    return Trend{fit.coefficients[slope_column],
                 std::sqrt(variance_of(problem.readings, influence) + known)};
}

std::vector<Step> steps_of(const Ages& ages, const Trial& trial) {
    const auto sizes = sizes_of(trial);
    std::vector<Step> steps;
    for (std::size_t i = 0; i < trial.step_years.size(); ++i) {
        const auto before_ms = std::llround(trial.step_years[i] * ms_per_year);
        steps.push_back({ages.newest_ms - before_ms, sizes[static_cast<Index>(i)]});
    }
    std::ranges::sort(steps, {}, &Step::utc_ms);
    return steps;
}

} // namespace

RoughnessTrend roughness_level(const FusionObservations& readings,
                               const std::vector<std::optional<std::int64_t>>& utc_ms,
                               double level_um,
                               const TailModel& tail,
                               const ChangeModel& change) {
    const auto ages = ages_of(utc_ms);
    const Problem problem{readings, ages, level_um, tail, change};
    auto trial = with_steps(problem);
    const auto& fit = trial.robust.fit;
    return {.um = fit.coefficients[level_column],
            .influence = influence_on(readings, trial.mean, trial.robust.trust, fit, level_column),
            .change_variance_um2 =
                trial.mean.precisions.dot(fit.inverse.col(level_column).cwiseAbs2()),
            .trust = trial.robust.trust,
            .expected_um = trial.mean.columns * fit.coefficients,
            .trend = trend_of(problem, trial),
            .steps = steps_of(ages, trial)};
}

} // namespace macadam
