#include "mapping/fusion.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace macadam {
namespace {

constexpr double um_per_mm = 1000;
constexpr double interval_90 = 1.645;  // two-sided, normal distribution
constexpr double sd_over_mad = 1.4826; // normal distribution
constexpr double ms_per_year = 365.25 * 86400e3;
constexpr int most_rounds = 50; // a round shrinks the step by 2 to 10
constexpr double settled_um = 1e-4;

struct Reading {
    double value_um;
    double weight;
};

/// Middle of the readings by weight; halfway between two where they share it evenly.
double weighted_median(std::vector<Reading> readings) {
    std::sort(readings.begin(), readings.end(), [](const Reading& a, const Reading& b) {
        return std::pair{a.value_um, a.weight} < std::pair{b.value_um, b.weight};
    });
    double whole = 0;
    for (const auto& reading : readings) {
        whole += reading.weight;
    }
    double passed = 0;
    for (std::size_t i = 0; i + 1 < readings.size(); ++i) {
        passed += readings[i].weight;
        if (std::abs(2 * passed - whole) <= 1e-12 * whole) {
            return (readings[i].value_um + readings[i + 1].value_um) / 2;
        }
        if (2 * passed > whole) {
            return readings[i].value_um;
        }
    }
    return readings.back().value_um;
}

double square(double x) {
    return x * x;
}

/// A pass as the mean sees it.
struct Vote {
    double value_um;
    double sd_um;
    double variance_um2; ///< sd^2 + between^2
    double strange_um2;  ///< squared distance from the mean that is nothing strange
    double weight = 0;   ///< in the mean
};

std::vector<Reading> readings_of(const std::vector<Vote>& votes) {
    std::vector<Reading> readings;
    readings.reserve(votes.size());
    for (const auto& vote : votes) {
        readings.push_back({vote.value_um, 1 / vote.variance_um2});
    }
    return readings;
}

/// The middle of what the passes read, each alike.
double level_um(std::span<const FusionInput> passes) {
    std::vector<Reading> readings;
    readings.reserve(passes.size());
    for (const auto& input : passes) {
        readings.push_back({static_cast<double>(input.pass.iri_um), 1});
    }
    return weighted_median(std::move(readings));
}

double between_um2(double level_um, const FusionConfig& config) {
    return square(config.between_relative_sd * level_um) +
           square(config.between_sd_mm_per_m * um_per_mm);
}

/// A pass's own sd, as it would be had the pass read what the segment is. Most of it is a share of
/// what was read, and a pass must not gain weight by reading low.
double sd_at_level_um(const Pass& pass, double level_um) {
    return pass.sd_um * level_um / std::max<double>(1, pass.iri_um);
}

struct Fused {
    double mean_um;
    double rest_um2;         ///< between^2
    std::vector<Vote> votes; ///< as many as passes
};

double median_um(const std::vector<Vote>& votes) {
    return weighted_median(readings_of(votes));
}

double median_deviation_um(const std::vector<Vote>& votes, double middle_um) {
    auto readings = readings_of(votes);
    for (auto& reading : readings) {
        reading.value_um = std::abs(reading.value_um - middle_um);
    }
    return weighted_median(std::move(readings));
}

/// The weights of the t distribution about `mean_um`, and the mean under them.
double reweighted_mean(std::vector<Vote>& votes, double mean_um, double dof) {
    double weights = 0, sum = 0;
    for (auto& vote : votes) {
        const double strange = square(vote.value_um - mean_um) / vote.strange_um2;
        vote.weight = (dof + 1) / (dof + strange) / vote.variance_um2;
        weights += vote.weight;
        sum += vote.weight * vote.value_um;
    }
    return sum / weights;
}

Fused fused(std::span<const FusionInput> passes, const FusionConfig& config) {
    const double middle_um = level_um(passes);
    const double rest_um2 = between_um2(middle_um, config);
    std::vector<Vote> votes;
    votes.reserve(passes.size());
    for (const auto& input : passes) {
        const double sd_um = sd_at_level_um(input.pass, middle_um);
        votes.push_back(
            {static_cast<double>(input.pass.iri_um), sd_um, square(sd_um) + rest_um2, 0});
    }
    double mean_um = median_um(votes);
    const double scatter_um2 = square(sd_over_mad * median_deviation_um(votes, mean_um));
    for (auto& vote : votes) {
        vote.strange_um2 = rest_um2 + std::min(square(vote.sd_um), scatter_um2);
    }
    for (int round = 0; round < most_rounds; ++round) {
        const double before_um =
            std::exchange(mean_um, reweighted_mean(votes, mean_um, config.heavy_tail_dof));
        if (std::abs(mean_um - before_um) < settled_um) {
            break;
        }
    }
    return {mean_um, rest_um2, std::move(votes)};
}

/// By how much the passes scatter more than they claim, at least 1.
double excess(const Fused& all) {
    if (all.votes.size() < 2) {
        return 1;
    }
    double strangeness = 0, most = 0;
    for (const auto& vote : all.votes) {
        most = std::max(most, vote.weight * vote.variance_um2);
    }
    for (const auto& vote : all.votes) {
        const double trust = vote.weight * vote.variance_um2 / most;
        strangeness += trust * square(vote.value_um - all.mean_um) / vote.variance_um2;
    }
    return std::sqrt(std::max(1.0, strangeness / static_cast<double>(all.votes.size() - 1)));
}

/// Places of the passes' vehicles in a list of them by first appearance, so that what numbers they
/// have changes no sum.
std::vector<std::size_t> cars_of(std::span<const FusionInput> passes) {
    std::unordered_map<std::int64_t, std::size_t> known;
    std::vector<std::size_t> cars;
    cars.reserve(passes.size());
    for (const auto& input : passes) {
        cars.push_back(known.try_emplace(input.vehicle, known.size()).first->second);
    }
    return cars;
}

std::size_t count_of(const std::vector<std::size_t>& cars) {
    return *std::max_element(cars.begin(), cars.end()) + 1;
}

double sd_of_mean_um(const Fused& all, const std::vector<std::size_t>& cars, double common_share) {
    double weights = 0, scatter = 0;
    std::vector<double> of_car(count_of(cars), 0.0);
    for (std::size_t i = 0; i < all.votes.size(); ++i) {
        const auto& vote = all.votes[i];
        weights += vote.weight;
        scatter += square(vote.weight) * all.rest_um2;
        of_car[cars[i]] += vote.weight * vote.sd_um;
    }
    const double by_car = std::inner_product(of_car.begin(), of_car.end(), of_car.begin(), 0.0);
    const double by_all = square(std::accumulate(of_car.begin(), of_car.end(), 0.0));
    const double shared = std::lerp(by_car, by_all, common_share);
    return excess(all) * std::sqrt(scatter + shared) / weights;
}

IriUm whole_um(double um) {
    return static_cast<IriUm>(std::lround(um));
}

std::optional<IriUm> side_um(std::span<const FusionInput> passes,
                             const std::vector<Vote>& votes,
                             std::optional<IriUm> Pass::*side) {
    double weights = 0, sum = 0;
    for (std::size_t i = 0; i < passes.size(); ++i) {
        if (const auto value_um = passes[i].pass.*side) {
            weights += votes[i].weight;
            sum += votes[i].weight * *value_um;
        }
    }
    return weights > 0 ? std::optional{whole_um(sum / weights)} : std::nullopt;
}

/// Slope of the weighted line through the dated passes.
std::optional<IriUm> trend_um_per_year(std::span<const FusionInput> passes,
                                       const std::vector<Vote>& votes,
                                       std::int64_t first_ms) {
    double weights = 0, sum_t = 0, sum_x = 0, sum_tt = 0, sum_tx = 0, span = 0;
    for (std::size_t i = 0; i < passes.size(); ++i) {
        if (!passes[i].utc_ms) {
            continue;
        }
        const double t = static_cast<double>(*passes[i].utc_ms - first_ms) / ms_per_year;
        const double w = votes[i].weight, x = votes[i].value_um;
        weights += w;
        sum_t += w * t;
        sum_x += w * x;
        sum_tt += w * t * t;
        sum_tx += w * t * x;
        span = std::max(span, t);
    }
    if (span <= 1) {
        return std::nullopt;
    }
    return whole_um((weights * sum_tx - sum_t * sum_x) / (weights * sum_tt - sum_t * sum_t));
}

/// What needs no weights: counts, dates, flags.
SegmentState gathered(std::span<const FusionInput> passes) {
    SegmentState state{};
    state.segment = passes.front().pass.segment;
    state.passes = static_cast<std::int32_t>(passes.size());
    state.centre_only = true;
    state.validity = 0xff;
    for (const auto& [pass, trip, vehicle, utc_ms] : passes) {
        state.centre_only = state.centre_only && pass.centre_only;
        state.validity &= pass.validity;
        if (utc_ms) {
            state.first_seen_ms = std::min(state.first_seen_ms.value_or(*utc_ms), *utc_ms);
            state.last_seen_ms = std::max(state.last_seen_ms.value_or(*utc_ms), *utc_ms);
        }
    }
    return state;
}

} // namespace

SegmentState fuse(std::span<const FusionInput> passes, const FusionConfig& config) {
    assert(!passes.empty());
    const auto all = fused(passes, config);
    const auto cars = cars_of(passes);
    const double sd_um = sd_of_mean_um(all, cars, config.common_share);

    auto state = gathered(passes);
    state.iri_um = whole_um(all.mean_um);
    state.sd_um = std::max(1, whole_um(sd_um));
    state.low_um = std::max(0, whole_um(all.mean_um - interval_90 * sd_um));
    state.high_um = whole_um(all.mean_um + interval_90 * sd_um);
    state.left_um = side_um(passes, all.votes, &Pass::iri_left_um);
    state.right_um = side_um(passes, all.votes, &Pass::iri_right_um);
    state.vehicles = static_cast<std::int32_t>(count_of(cars));
    if (state.first_seen_ms) {
        state.trend_um_per_year = trend_um_per_year(passes, all.votes, *state.first_seen_ms);
    }
    return state;
}

} // namespace macadam
