#include "mapping/alignment/alignment.hpp"

#include "estimator/common/statistics.hpp"
#include "mapping/alignment/lag_search.hpp"
#include "mapping/alignment/mean_signal.hpp"
#include "mapping/alignment/shifted_signal.hpp"
#include "mapping/alignment/signal.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

namespace macadam {
namespace {

constexpr double seed_weight = 0.5; // weight of a trace before its agreement is known
// rho^2 * (independent values) of two unrelated traces is the square of a standard normal variable.
// The best of 21 lags must reach three standard deviations; a lag profile chosen block by block
// must reach more.
constexpr double min_evidence = 9;
constexpr double min_evidence_in_block = 2;
constexpr double max_agreement = 0.95;

/// State of a trace during alignment.
struct Member {
    Signal signal; ///< padded
    double place_sd_m;
    double independent_m; ///< length of an independent value of the signal
    LagPrior prior;
    std::int32_t first_block;
    std::vector<std::int32_t> lag_cm; ///< one per block
    Signal shifted;                   ///< the signal shifted by its lags
    double agreement = 0;             ///< rho^2 with the other traces
    LagStatus finding = LagStatus::alone;
    SignalWeight weight{}; ///< of the shifted signal in the mean of all
};

bool is_found(const Member& member) {
    return member.finding == LagStatus::found;
}

Member member_of(const RoughnessTrace& trace, const AlignmentConfig& config) {
    const auto signal = signal_of(trace);
    const auto last_m = trace.first_m + static_cast<std::int32_t>(trace.iri.size()) - 1;
    const auto first_block = block_of(trace.first_m);
    const auto blocks = static_cast<std::size_t>(block_of(last_m) - first_block + 1);
    const double sd_m = std::max(0.1, trace.place_sd_mm / 1000.0);
    return {.signal = padded(signal),
            .place_sd_m = sd_m,
            .independent_m = independent_m(signal.x),
            .prior = prior_of(sd_m, config.prior_dof, config.drift_m2_per_m * lag_block_m, blocks),
            .first_block = first_block,
            .lag_cm = std::vector<std::int32_t>(blocks),
            .shifted = {}};
}

/// Resets a member: unshifted, and without weight in the mean.
Member unaligned(Member member, LagStatus finding) {
    std::ranges::fill(member.lag_cm, 0);
    member.agreement = 0;
    member.finding = finding;
    member.weight = {};
    return member;
}

/// Shifts the signal of a member by its lag.
Member shift_to_lag(Member member) {
    member.shifted = shifted_signal(member.signal, member.first_block, member.lag_cm);
    return member;
}

// --------------------------------------------------------------------------------- common mean

SignalTemplate empty_template_of(std::span<const Member> members) {
    auto first_m = members.front().shifted.first_m;
    auto last_m = first_m;
    for (const auto& member : members) {
        const auto& shifted = member.shifted;
        first_m = std::min(first_m, shifted.first_m);
        last_m = std::max(last_m, shifted.first_m + static_cast<std::int32_t>(shifted.x.size()));
    }
    return empty_template(first_m, last_m);
}

// ------------------------------------------------------------------------------------ agreement

constexpr std::size_t part_m = slack_m; // cells multiplied at once

/// Not inlined: inside the loop over lags, compilers would multiply lag by lag instead of eight
/// cells at once.
[[gnu::noinline]] std::int32_t part_dot(const std::int16_t* a, const std::int16_t* b) {
    std::int32_t sum = 0;
    for (std::size_t i = 0; i < part_m; ++i) {
        sum += std::int32_t{a[i]} * b[i];
    }
    return sum;
}

/// Correlates template and signal over each block, for each whole-metre lag.
std::vector<Correlation> correlations(const Member& member, const Signal& reference) {
    std::vector<Correlation> sums(member.lag_cm.size(), Correlation{});
    const auto last_block = sums.size() - 1;
    const auto end = reference.x.size();
    for (std::size_t b = 0, first = 0; b <= last_block; ++b) {
        const auto border_m = static_cast<std::int32_t>(lag_block_m) *
                              (member.first_block + static_cast<std::int32_t>(b) + 1);
        const auto last =
            b == last_block ? end : static_cast<std::size_t>(border_m - reference.first_m);
        for (; first < last; first = std::min(first + part_m, last)) {
            std::array<std::int16_t, part_m> here{};
            std::copy_n(reference.x.begin() + static_cast<std::ptrdiff_t>(first),
                        std::min(part_m, last - first),
                        here.begin());
            const auto* const opposite = member.signal.x.data() + first; // at lag -reach_m
            for (std::size_t lag = 0; lag < lag_count; ++lag) {
                sums[b][lag] += part_dot(here.data(), opposite + lag);
            }
        }
    }
    return sums;
}

struct Agreement {
    double share; ///< rho^2 of signal and template; 0: possibly chance
    double scale; ///< factor from a correlation sum to a log-likelihood
};

/// Sums over the cells where both the shifted member and the template are known.
struct Overlap {
    double metres;
    double reference_2; ///< sums of squares
    double signal_2;
    double product;
};

std::vector<std::int16_t> masked(const std::vector<std::int16_t>& x,
                                 const std::vector<std::int16_t>& known) {
    std::vector<std::int16_t> both(x.size());
    std::ranges::transform(x, known, both.begin(), [](auto value, auto mask) {
        return static_cast<std::int16_t>(value & mask);
    });
    return both;
}

Overlap overlap_of(const Member& member, const Signal& reference) {
    const auto r = masked(reference.x, member.shifted.known);
    const auto x = masked(member.shifted.x, reference.known);
    const auto sum = [](const auto& a, const auto& b) { return static_cast<double>(dot(a, b)); };
    return {.metres = sum(reference.known, member.shifted.known), // a product of -1 and -1
            .reference_2 = sum(r, r),
            .signal_2 = sum(x, x),
            .product = sum(r, x)};
}

/// Returns the maximum over lags of the sum over all blocks.
double best_at_one_lag(std::span<const Correlation> sums) {
    std::int64_t best = 0;
    for (std::size_t lag = 0; lag < lag_count; ++lag) {
        std::int64_t whole = 0;
        for (const auto& sum : sums) {
            whole += sum[lag];
        }
        best = std::max(best, whole);
    }
    return static_cast<double>(best);
}

/// Returns rho^2 of a correlation sum, corrected for chance; 0 if chance may explain all of it.
double sure_share(double product, double needed, double independent, const Overlap& overlap) {
    const double share = product * product / (overlap.reference_2 * overlap.signal_2);
    if (product <= 0 || share * independent < needed) {
        return 0;
    }
    return std::clamp((share * independent - 1) / std::max(1.0, independent - 1),
                      0.0,
                      max_agreement * max_agreement);
}

Agreement
agreement_of(const Member& member, const Signal& reference, std::span<const Correlation> sums) {
    const auto overlap = overlap_of(member, reference);
    if (!(overlap.reference_2 > 0) || !(overlap.signal_2 > 0)) {
        return {0, 0};
    }
    const double independent = overlap.metres / member.independent_m;
    const double chosen = min_evidence + min_evidence_in_block * static_cast<double>(sums.size());
    const double share =
        std::max(sure_share(best_at_one_lag(sums), min_evidence, independent, overlap),
                 sure_share(overlap.product, chosen, independent, overlap));
    const double unit = std::sqrt(overlap.reference_2 / overlap.metres) * signal_unit;
    return {share, std::sqrt(share) / (1 - share) / unit / member.independent_m};
}

SignalWeight weight_of(double share) {
    const auto whole = [](double weight) {
        return static_cast<std::int32_t>(std::lround(weight_unit * weight));
    };
    return {whole(std::sqrt(share) / (1 - share)), whole(share / (1 - share))};
}

/// Shifts a member to its best agreement with the other members, from which `reference` is built.
Member placed(Member member, const SignalTemplate& reference) {
    const auto under = profile_signal(reference, member.shifted.first_m, member.shifted.x.size());
    const auto sums = correlations(member, under);
    const auto agreement = agreement_of(member, under, sums);
    if (agreement.share <= 0) {
        return shift_to_lag(unaligned(std::move(member), LagStatus::alone));
    }
    const auto lags_cm = best_lags_cm(sums, agreement.scale, member.prior);
    if (!lags_cm) {
        return shift_to_lag(unaligned(std::move(member), LagStatus::beyond_reach));
    }
    member.lag_cm = *lags_cm;
    member.agreement = agreement.share;
    member.finding = LagStatus::found;
    member.weight = weight_of(agreement.share);
    return shift_to_lag(std::move(member));
}

// ---------------------------------------------------------------------------------------- datum

/// Mean lag of all found members in each block.
struct Datum {
    std::int32_t first_block;
    std::vector<std::int32_t> lag_cm;
};

Datum datum_of(std::span<const Member> members) {
    auto first = members.front().first_block;
    auto last = first;
    for (const auto& member : members) {
        first = std::min(first, member.first_block);
        last = std::max(last, member.first_block + static_cast<std::int32_t>(member.lag_cm.size()));
    }
    const auto count = static_cast<std::size_t>(last - first);
    std::vector<double> weights(count);
    std::vector<double> sums(count);
    for (const auto& member : members) {
        const double weight = member.agreement / (member.place_sd_m * member.place_sd_m);
        for (std::size_t b = 0; b < member.lag_cm.size(); ++b) {
            const auto at = b + static_cast<std::size_t>(member.first_block - first);
            weights[at] += weight;
            sums[at] += weight * member.lag_cm[b];
        }
    }
    Datum datum{first, {}};
    for (std::size_t at = 0; at < count; ++at) {
        datum.lag_cm.push_back(
            weights[at] > 0 ? static_cast<std::int32_t>(std::lround(sums[at] / weights[at])) : 0);
    }
    return datum;
}

/// Shifts all found members so that their lags in each block have mean 0. Members beyond reach are
/// reset. \returns true if there were any.
bool move_to(const Datum& datum, std::vector<Member>& members) {
    constexpr std::int32_t farthest_cm = 100 * reach_m;
    bool lost = false;
    for (auto& member : members) {
        bool near = true;
        for (std::size_t b = 0; is_found(member) && b < member.lag_cm.size(); ++b) {
            member.lag_cm[b] -=
                datum.lag_cm[b + static_cast<std::size_t>(member.first_block - datum.first_block)];
            near = near && std::abs(member.lag_cm[b]) < farthest_cm;
        }
        if (!near) {
            member = unaligned(std::move(member), LagStatus::beyond_reach);
            lost = true;
        }
    }
    return lost;
}

void hold_datum(std::vector<Member>& members) {
    while (move_to(datum_of(members), members)) {
    }
}

// ---------------------------------------------------------------------------------------- rounds

/// Aligns each member with those before it, so that the mean is sharp from the start despite
/// position errors.
void lay_first(std::vector<Member>& members) {
    constexpr auto seed = static_cast<std::int32_t>(seed_weight * weight_unit);
    auto reference = empty_template_of(members);
    for (auto& member : members) {
        member = placed(std::move(member), reference);
        member.agreement = 1;
        member.weight = {seed, seed};
        reference = with(std::move(reference), member.shifted, member.weight);
    }
}

void lay_again(std::vector<Member>& members) {
    auto reference = empty_template_of(members);
    for (auto& member : members) {
        member = shift_to_lag(std::move(member));
        reference = with(std::move(reference), member.shifted, member.weight);
    }
    for (auto& member : members) {
        reference = with(std::move(reference), member.shifted, member.weight, -1);
        member = placed(std::move(member), reference);
        reference = with(std::move(reference), member.shifted, member.weight);
    }
}

LagLine line_of(const Member& member) {
    const bool moves = std::ranges::any_of(member.lag_cm, [](auto cm) { return cm != 0; });
    return moves ? LagLine{member.first_block, member.lag_cm, member.finding}
                 : LagLine{0, {}, member.finding};
}

/// Returns the absolute mean lag along the line.
std::int32_t mean_size_cm(const LagLine& line) {
    const auto sum = std::accumulate(line.lag_cm.begin(), line.lag_cm.end(), std::int64_t{0});
    const auto count = std::max<std::int64_t>(1, std::ssize(line.lag_cm));
    return static_cast<std::int32_t>(std::abs(sum) / count);
}

} // namespace

double lag_m(const LagLine& line, double station) {
    const auto& lags_cm = line.lag_cm;
    if (lags_cm.empty()) {
        return 0;
    }
    const double place = station / lag_block_m - 0.5 - line.first_block;
    const double last = static_cast<double>(lags_cm.size()) - 1;
    const double held = std::clamp(place, 0.0, last);
    const auto before = static_cast<std::size_t>(std::min(held, std::max(0.0, last - 1)));
    const auto after = std::min(before + 1, lags_cm.size() - 1);
    const double share = held - static_cast<double>(before);
    return (lags_cm[before] + share * (lags_cm[after] - lags_cm[before])) / 100;
}

AlignmentSummary summary_of(std::span<const LagLine> lines) {
    AlignmentSummary summary{.drives = static_cast<std::int64_t>(lines.size())};
    std::vector<std::int32_t> lags_cm; // of drives found
    for (const auto& line : lines) {
        summary.beyond_reach += line.finding == LagStatus::beyond_reach ? 1 : 0;
        if (line.finding == LagStatus::found) {
            lags_cm.push_back(mean_size_cm(line));
        }
    }
    summary.found = std::ssize(lags_cm);
    summary.moved_far =
        std::ranges::count_if(lags_cm, [](auto cm) { return cm > 100 * far_lag_m; });
    summary.middle_lag_cm = median(std::move(lags_cm));
    return summary;
}

std::vector<LagLine> lags_of(std::span<const RoughnessTrace> traces,
                             const AlignmentConfig& config) {
    if (traces.size() < 2) {
        return std::vector<LagLine>(traces.size());
    }
    std::vector<Member> members;
    members.reserve(traces.size());
    for (const auto& trace : traces) {
        assert(!trace.iri.empty());
        members.push_back(shift_to_lag(member_of(trace, config)));
    }
    lay_first(members);
    for (int round = 0; round < config.rounds; ++round) {
        hold_datum(members);
        lay_again(members);
    }
    hold_datum(members);
    std::vector<LagLine> lines;
    lines.reserve(members.size());
    for (const auto& member : members) {
        lines.push_back(line_of(member));
    }
    return lines;
}

} // namespace macadam
