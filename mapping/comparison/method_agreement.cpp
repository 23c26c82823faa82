#include "mapping/comparison/method_agreement.hpp"

#include "mapping/surveys/control_section.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace macadam {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr double limit_sds = 1.96;        // Bland and Altman 1999, section 2
constexpr std::size_t max_lag = 50;       // segments: 1 km of road
constexpr std::size_t min_lag_pairs = 10; // fewer pairs say nothing of a correlation

/// Difference of a segment.
struct Difference {
    SegmentKey segment;
    double value;
};

/// Number of pairs at each distance along a road, and the mean product of their differences about
/// the mean.
struct Autocovariance {
    std::array<double, max_lag + 1> products{};
    std::array<std::size_t, max_lag + 1> counts{};
};

Autocovariance autocovariance_of(std::span<const Difference> differences, double mean) {
    Autocovariance sums;
    for (std::size_t i = 0; i < differences.size(); ++i) {
        const auto& here = differences[i];
        for (std::size_t j = i + 1; j < differences.size(); ++j) {
            const auto& there = differences[j];
            const bool same_road = there.segment.way_id == here.segment.way_id &&
                                   there.segment.forward == here.segment.forward;
            if (!same_road || there.segment.index - here.segment.index > max_lag) {
                break;
            }
            const auto lag = there.segment.index - here.segment.index;
            sums.products[lag] += (here.value - mean) * (there.value - mean);
            ++sums.counts[lag];
        }
    }
    return sums;
}

/// Effective numbers of differences for the mean and for the standard deviation.
struct EffectiveCounts {
    double mean;
    double sd;
};

EffectiveCounts
effective_counts(std::span<const Difference> differences, double mean, double variance) {
    const auto count = static_cast<double>(differences.size());
    const auto sums = autocovariance_of(differences, mean);
    double correlations = 0, squares = 0;
    for (std::size_t lag = 1; lag <= max_lag && sums.counts[lag] >= min_lag_pairs; ++lag) {
        const auto pairs = static_cast<double>(sums.counts[lag]);
        const double correlation = sums.products[lag] / pairs / variance;
        if (!(correlation > 0)) {
            break;
        }
        correlations += pairs / count * correlation;
        squares += pairs / count * correlation * correlation;
    }
    const auto effective = [&](double sum) { return std::max(2.0, count / (1 + 2 * sum)); };
    return {effective(correlations), effective(squares)};
}

Estimate with_margin(double value, double margin) {
    return {value, value - margin, value + margin};
}

/// \param differences  sorted by segment.
LimitsOfAgreement limits_of(std::span<const Difference> differences) {
    constexpr Estimate unknown{none, none, none};
    LimitsOfAgreement limits{unknown, none, unknown, unknown, none};
    const auto count = static_cast<double>(differences.size());
    if (differences.empty()) {
        return limits;
    }
    double sum = 0;
    for (const auto& difference : differences) {
        sum += difference.value;
    }
    const double bias = limits.bias.value = sum / count;
    if (differences.size() < 2) {
        return limits;
    }
    double squares = 0;
    for (const auto& difference : differences) {
        squares += (difference.value - bias) * (difference.value - bias);
    }
    const double sd = limits.sd = std::sqrt(squares / (count - 1));
    limits.lower.value = bias - limit_sds * sd;
    limits.upper.value = bias + limit_sds * sd;
    if (differences.size() < 3) {
        return limits; // no degree of freedom is left for an interval of the limits
    }
    const auto effective = sd > 0 ? effective_counts(differences, bias, squares / count)
                                  : EffectiveCounts{count, count};
    const double t = student_t_975(effective.mean - 1);
    limits.independent = effective.mean;
    limits.bias = with_margin(bias, t * sd / std::sqrt(effective.mean));
    const double margin =
        t * sd * std::sqrt(1 / effective.mean + limit_sds * limit_sds / (2 * (effective.sd - 1)));
    limits.lower = with_margin(limits.lower.value, margin);
    limits.upper = with_margin(limits.upper.value, margin);
    return limits;
}

double relative_percent(const AgreementPair& pair) {
    const double mean = (pair.a + pair.b) / 2;
    return mean > 0 ? 100 * (pair.a - pair.b) / mean : 0;
}

} // namespace

MethodAgreement agreement_of(std::span<const AgreementPair> pairs) {
    std::vector<AgreementPair> sorted{pairs.begin(), pairs.end()};
    std::ranges::sort(sorted, {}, &AgreementPair::segment);
    std::vector<Difference> differences, relative;
    differences.reserve(sorted.size());
    relative.reserve(sorted.size());
    double a = 0, b = 0;
    for (const auto& pair : sorted) {
        a += pair.a;
        b += pair.b;
        differences.push_back({pair.segment, pair.a - pair.b});
        relative.push_back({pair.segment, relative_percent(pair)});
    }
    const double count = sorted.empty() ? none : static_cast<double>(sorted.size());
    return {.pairs = sorted.size(),
            .mean_a = a / count,
            .mean_b = b / count,
            .difference = limits_of(differences),
            .relative = limits_of(relative)};
}

std::vector<AgreementGroup> agreement_by_group(std::span<const AgreementPair> pairs,
                                               std::span<const GroupName> names) {
    std::map<std::pair<int, std::string>, std::vector<AgreementPair>> members;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (!names[i].name.empty()) {
            members[{names[i].rank, names[i].name}].push_back(pairs[i]);
        }
    }
    std::vector<AgreementGroup> groups;
    groups.reserve(members.size());
    for (const auto& [name, group] : members) {
        groups.push_back({name.second, agreement_of(group)});
    }
    return groups;
}

} // namespace macadam
