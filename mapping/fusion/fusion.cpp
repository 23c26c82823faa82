#include "mapping/fusion/fusion.hpp"

#include "estimator/common/statistics.hpp"
#include "mapping/fusion/pass_observations.hpp"
#include "mapping/fusion/roughness_time_series.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

constexpr double stated_passes = 6; // pseudo-observations that scatter as stated
constexpr double stated_cars = 12; // pseudo-observations of cars that differ as stated, so that few
                                   // cars that agree by chance are not taken for sure
using Eigen::Index;
using Eigen::VectorXd;

struct Weighed {
    double value_um;
    double weight;
};

/// Returns the weighted median; halfway between two values if the weights balance.
double weighted_median(std::vector<Weighed> values) {
    std::sort(values.begin(), values.end(), [](const Weighed& a, const Weighed& b) {
        return std::pair{a.value_um, a.weight} < std::pair{b.value_um, b.weight};
    });
    double whole = 0;
    for (const auto& value : values) {
        whole += value.weight;
    }
    double passed = 0;
    for (std::size_t i = 0; i + 1 < values.size(); ++i) {
        passed += values[i].weight;
        if (std::abs(2 * passed - whole) <= 1e-12 * whole) {
            return (values[i].value_um + values[i + 1].value_um) / 2;
        }
        if (2 * passed > whole) {
            return values[i].value_um;
        }
    }
    return values.back().value_um;
}

/// Returns the unweighted median of the readings.
double level_um(const VectorXd& values) {
    std::vector<Weighed> alike;
    for (const double value_um : values) {
        alike.push_back({value_um, 1});
    }
    return std::max(1.0, weighted_median(std::move(alike)));
}

VectorXd trip_variances(const FusionObservations& readings) {
    VectorXd variances = VectorXd::Zero(readings.values.size());
    for (const auto& [first, count] : readings.trips) {
        variances.segment(first, count).setConstant(readings.trip_sd * readings.trip_sd);
    }
    return variances;
}

/// Returns the variance of each single reading, without the part common to all cars.
VectorXd variances_of(const FusionObservations& readings) {
    return readings.car_sd.array().square() + readings.rest_sd.array().square() +
           trip_variances(readings).array();
}

double scatter_um(const VectorXd& values, const VectorXd& variances) {
    std::vector<Weighed> weighed;
    for (Index i = 0; i < values.size(); ++i) {
        weighed.push_back({values[i], 1 / variances[i]});
    }
    const double middle_um = weighted_median(weighed);
    for (auto& value : weighed) {
        value.value_um = std::abs(value.value_um - middle_um);
    }
    return normal_sd_per_mad * weighted_median(std::move(weighed));
}

/// Returns 1 / variance of each single reading at the weights of the reading and its car.
VectorXd weights_of(const FusionObservations& readings, const RobustWeights& trust) {
    VectorXd variances = readings.rest_sd.array().square() / trust.of_reading.array() +
                         trip_variances(readings).array();
    for (Index i = 0; const auto& [first, count] : readings.cars) {
        variances.segment(first, count).array() +=
            readings.car_sd.segment(first, count).array().square() / trust.of_car[i++];
    }
    return variances.cwiseInverse();
}

/// Returns the excess of the scatter of the passes over what they state, >= 1.
double
excess(const FusionObservations& readings, const RoughnessTrend& level, const VectorXd& weights) {
    const VectorXd variances = variances_of(readings);
    const VectorXd trust = weights.cwiseProduct(variances);
    const VectorXd off = readings.values - level.expected_um;
    const double strangeness =
        (trust.array() * off.array().square() / variances.array()).sum() / trust.maxCoeff();
    const auto others = static_cast<double>(readings.values.size() - 1);
    return std::sqrt(std::max(1.0, (stated_passes + strangeness) / (stated_passes + others)));
}

/// Returns the factor, <= 1, on the errors that cars do not share, if the means of two or more cars
/// (of their periods, if they changed) agree better than they state.
double agreement(const FusionObservations& readings, const VectorXd& off) {
    double strangeness = 0;
    auto trip = readings.trips.begin();
    for (const auto& [first, count] : readings.cars) {
        const VectorXd precision =
            readings.rest_sd.segment(first, count).cwiseAbs2().cwiseInverse();
        const double whole = precision.sum();
        const double mean = precision.dot(off.segment(first, count)) / whole;
        double trips = 0;
        for (; trip != readings.trips.end() && trip->first < first + count; ++trip) {
            ++trips;
        }
        const double of_trips = readings.trip_sd * readings.trip_sd / std::max(1.0, trips);
        const double own = precision.dot(readings.car_sd.segment(first, count).cwiseAbs2()) / whole;
        strangeness += mean * mean / (own + of_trips + 1 / whole);
    }
    const auto others = static_cast<double>(readings.cars.size() - 1);
    return std::sqrt(std::min(1.0, (stated_cars + strangeness) / (stated_cars + others)));
}

/// Averages the distance of one side from the headline over the passes since `from_ms`.
std::optional<double> side_off_um(const std::vector<const FusionInput*>& passes,
                                  const VectorXd& weights,
                                  std::optional<IriUm> Pass::*side,
                                  const std::optional<RoadChange>& change) {
    double whole = 0, sum = 0;
    for (std::size_t i = 0; i < passes.size(); ++i) {
        const auto& input = *passes[i];
        const auto side_um = input.pass.*side;
        const bool old = change && input.utc_ms && *input.utc_ms < change->utc_ms;
        if (side_um && !old) {
            const double weight = weights[static_cast<Index>(i)];
            whole += weight;
            sum += weight * (true_um(input, *side_um) - true_um(input, input.pass.iri_um));
        }
    }
    return whole > 0 ? std::optional{sum / whole} : std::nullopt;
}

IriUm whole_um(double um) {
    return static_cast<IriUm>(std::lround(um));
}

std::optional<IriUm> side_um(double level_um, const std::optional<double>& off_um) {
    return off_um ? std::optional{std::max(0, whole_um(level_um + *off_um))} : std::nullopt;
}

/// Collects values that need no weights: counts, dates, flags.
SegmentState gathered(std::span<const FusionInput> passes) {
    SegmentState state{};
    state.segment = passes.front().pass.segment;
    state.centre_only = true;
    state.validity = 0xff;
    for (const auto& input : passes) {
        const auto& utc_ms = input.utc_ms;
        state.passes += input.reference ? 0 : 1;
        state.centre_only = state.centre_only && input.pass.centre_only;
        state.validity &= input.pass.validity;
        if (utc_ms) {
            state.first_seen_ms = std::min(state.first_seen_ms.value_or(*utc_ms), *utc_ms);
            state.last_seen_ms = std::max(state.last_seen_ms.value_or(*utc_ms), *utc_ms);
        }
    }
    return state;
}

SegmentState with_level(SegmentState state, const RoughnessTrend& level, double sd_um) {
    state.iri_um = std::max(0, whole_um(level.um));
    state.sd_um = std::max(1, whole_um(sd_um));
    state.low_um = std::max(0, whole_um(level.um - normal_interval_90 * sd_um));
    state.high_um = std::max(state.iri_um, whole_um(level.um + normal_interval_90 * sd_um));
    if (level.trend) {
        state.trend_um_per_year = whole_um(level.trend->um_per_year);
        state.trend_sd_um_per_year = whole_um(level.trend->sd_um_per_year);
    }
    if (!level.steps.empty()) {
        const auto& last = level.steps.back();
        state.change = RoadChange{last.utc_ms, whole_um(last.um)};
    }
    return state;
}

/// Returns the sd of the error common to all cars for each reading.
VectorXd common_sd(const VectorXd& of_cars, double level_um, const FusionConfig& config) {
    return of_cars.unaryExpr([&](double common_um) {
        return common_um > 0 ? std::hypot(common_um, config.anchor_relative_sd * level_um) : 0.0;
    });
}

/// Counts the cars of passes that are sorted by car.
std::int32_t cars_in(const std::vector<const FusionInput*>& passes) {
    std::int32_t cars = 0;
    for (std::size_t i = 0; i < passes.size(); ++i) {
        const bool is_next = i == 0 || passes[i]->vehicle != passes[i - 1]->vehicle;
        cars += is_next && !passes[i]->reference ? 1 : 0;
    }
    return cars;
}

std::vector<std::optional<std::int64_t>> times_of(const std::vector<const FusionInput*>& passes) {
    std::vector<std::optional<std::int64_t>> times;
    times.reserve(passes.size());
    for (const auto* input : passes) {
        times.push_back(input->utc_ms);
    }
    return times;
}

} // namespace

SegmentState fuse(std::span<const FusionInput> passes, const FusionConfig& config) {
    assert(!passes.empty());
    const auto sorted = by_car(passes);
    const VectorXd values = values_of(sorted);
    const double middle_um = level_um(values);
    const VectorXd stated = stated_um(sorted, middle_um);
    const auto parts = stated_parts(sorted, stated, middle_um, config);
    const VectorXd of_cars = of_cars_alone(sorted, stated);
    const bool beside_references = of_cars.maxCoeff() > 0 && of_cars.minCoeff() <= 0;
    // The error common to all cars cannot be reduced by weighting, yet it makes a pass worth less;
    // next to references it is estimated.
    const VectorXd none = VectorXd::Zero(values.size());
    auto weighed = beside_references
                       ? observations_of(sorted, values, stated, parts.car, none, middle_um, config)
                       : observations_of(sorted,
                                         values,
                                         stated,
                                         std::sqrt(config.car_share) * stated,
                                         std::sqrt(config.common_share) * stated,
                                         middle_um,
                                         config);
    if (beside_references) {
        weighed.common_sd = common_sd(parts.common, middle_um, config);
    }
    auto tail = config.tail;
    tail.scatter_sd = scatter_um(values, variances_of(weighed));
    const auto level = roughness_level(weighed, times_of(sorted), middle_um, tail, config.change);

    const auto weights = weights_of(weighed, level.trust);
    const auto apart = observations_of(sorted, values, stated, parts.car, none, middle_um, config);
    const VectorXd cars_part = of_cars_alone(sorted, level.influence);
    const auto cars = cars_in(sorted);
    const double agreed =
        beside_references || cars < 2 ? 1 : agreement(apart, values - level.expected_um);
    const double apart_um =
        std::sqrt(agreed * agreed * variance_of(apart, cars_part) + level.change_variance_um2);
    const double common_um = beside_references ? 0 : parts.common.dot(level.influence);
    const double anchor_um = of_cars.minCoeff() > 0 ? config.anchor_relative_sd * level.um : 0;
    const double factor = excess(weighed, level, weights);
    const double cars_um = std::hypot(factor * apart_um, factor * common_um, anchor_um);
    const double references_um =
        std::sqrt(variance_of(apart, VectorXd{level.influence - cars_part}));
    auto state = with_level(gathered(passes), level, std::hypot(cars_um, references_um));
    state.vehicles = cars;
    state.left_um =
        side_um(level.um, side_off_um(sorted, weights, &Pass::iri_left_um, state.change));
    state.right_um =
        side_um(level.um, side_off_um(sorted, weights, &Pass::iri_right_um, state.change));
    return state;
}

} // namespace macadam
