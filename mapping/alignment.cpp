#include "mapping/alignment.hpp"

#include "mapping/align/lag_search.hpp"
#include "mapping/align/signal.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace macadam {
namespace {

constexpr double seed_weight = 0.5; // of a trace in the mean before anything is known of it
// rho^2 * (independent values) of two traces is the square of a standard normal variable if they
// have nothing in common. The best of 21 lags has to be three standard deviations; a course of lags
// that was chosen block by block more.
constexpr double least_evidence = 9;
constexpr double least_evidence_in_block = 2;
constexpr double most_agreement = 0.95;

using Values = std::vector<float>;

/// A trace on its way to its place.
struct Member {
    Signal signal;
    double place_sd_m;
    double independent_m; ///< from one independent value of the signal to the next
    std::int32_t first_block;
    std::vector<double> lag_m; ///< of each block
    Signal laid;               ///< the signal at common places
    double agreement = 0;      ///< rho^2 with the others
    float weight = 0;          ///< of the laid signal in the mean of all
    float precision = 0;       ///< what it adds to that of the mean
};

// ------------------------------------------------------------------------------------- places

/// Of the metre that begins at a station.
std::int32_t block_of(std::int32_t metre) {
    constexpr auto length = static_cast<std::int32_t>(lag_block_m);
    static_assert(length == lag_block_m);
    return metre >= 0 ? metre / length : -((length - 1 - metre) / length);
}

double line_at(std::span<const double> lags_m, std::int32_t first_block, double station) {
    if (lags_m.empty()) {
        return 0;
    }
    const double place = station / lag_block_m - 0.5 - first_block;
    const double last = static_cast<double>(lags_m.size()) - 1;
    const double held = std::clamp(place, 0.0, last);
    const auto before = static_cast<std::size_t>(std::min(held, std::max(0.0, last - 1)));
    const auto after = std::min(before + 1, lags_m.size() - 1);
    const double share = held - static_cast<double>(before);
    return lags_m[before] + share * (lags_m[after] - lags_m[before]);
}

/// The signal where its lags put it, over all places that a lag can put it to.
Signal laid_down(const Member& member) {
    const auto& from = member.signal;
    const auto count = from.x.size() + 2 * reach_m;
    Signal laid{from.first_m - reach_m, Values(count), Values(count)};
    for (std::size_t i = 0; i < count; ++i) {
        const double station = laid.first_m + static_cast<double>(i) + 0.5;
        const double at =
            static_cast<double>(i) - reach_m + line_at(member.lag_m, member.first_block, station);
        if (at < 0 || at + 1 >= static_cast<double>(from.x.size())) {
            continue;
        }
        const auto k = static_cast<std::size_t>(at);
        const auto share = static_cast<float>(at - static_cast<double>(k));
        laid.x[i] = from.x[k] + share * (from.x[k + 1] - from.x[k]);
        laid.known[i] = from.known[k] * from.known[k + 1];
    }
    return laid;
}

Member member_of(const StripTrace& trace) {
    Member member{.signal = signal_of(trace),
                  .place_sd_m = std::max(0.1, trace.place_sd_mm / 1000.0),
                  .independent_m = 1,
                  .first_block = block_of(trace.first_m),
                  .lag_m = {},
                  .laid = {}};
    member.independent_m = independent_m(member.signal.x);
    const auto last_m = trace.first_m + static_cast<std::int32_t>(trace.iri.size()) - 1;
    member.lag_m.resize(static_cast<std::size_t>(block_of(last_m) - member.first_block + 1));
    return member;
}

// --------------------------------------------------------------------------------- common mean

/// What all laid signals say of the strip's texture: sums by place.
struct Texture {
    std::int32_t first_m;
    Values sum;
    Values precision;
};

Texture bare_texture(std::span<const Member> members) {
    auto first_m = members.front().signal.first_m;
    auto last_m = first_m;
    for (const auto& member : members) {
        first_m = std::min(first_m, member.signal.first_m);
        last_m = std::max(
            last_m, member.signal.first_m + static_cast<std::int32_t>(member.signal.x.size()));
    }
    const auto count = static_cast<std::size_t>(last_m - first_m + 2 * reach_m);
    return {first_m - reach_m, Values(count), Values(count)};
}

/// Adds a member's laid signal `sign` times.
void add(Texture& texture, const Member& member, float sign) {
    const auto first = static_cast<std::size_t>(member.laid.first_m - texture.first_m);
    const float weight = sign * member.weight;
    const float precision = sign * member.precision;
    for (std::size_t i = 0; i < member.laid.x.size(); ++i) {
        texture.sum[first + i] += weight * member.laid.x[i];
        texture.precision[first + i] += precision * member.laid.known[i];
    }
}

/// The most likely texture where a member may lie, if textures have variance 1.
Values texture_under(const Texture& texture, const Member& member) {
    const auto first = static_cast<std::size_t>(member.signal.first_m - reach_m - texture.first_m);
    Values under(member.signal.x.size() + 2 * reach_m);
    for (std::size_t i = 0; i < under.size(); ++i) {
        under[i] = texture.sum[first + i] / (1 + texture.precision[first + i]);
    }
    return under;
}

// ------------------------------------------------------------------------------------ agreement

/// Sums of texture times signal over the places of each block, for each whole lag.
std::vector<Correlation> correlations(const Member& member, const Values& texture) {
    constexpr std::size_t pad = 2 * reach_m;
    const auto& signal = member.signal;
    Values x(signal.x.size() + 2 * pad);
    std::ranges::copy(signal.x, x.begin() + pad);
    std::vector<Correlation> sums(member.lag_m.size(), Correlation{});
    const auto last_block = static_cast<std::int32_t>(sums.size()) - 1;
    for (std::size_t i = 0; i < texture.size(); ++i) {
        const auto metre = signal.first_m - reach_m + static_cast<std::int32_t>(i);
        const auto block = std::clamp(block_of(metre) - member.first_block, 0, last_block);
        auto& sum = sums[static_cast<std::size_t>(block)];
        const float r = texture[i];
        const float* const opposite = x.data() + i; // at lag -reach_m
        for (std::size_t lag = 0; lag < lag_count; ++lag) {
            sum[lag] += r * opposite[lag];
        }
    }
    return sums;
}

struct Agreement {
    double share; ///< rho^2 of signal and texture; 0: may be chance
    double scale; ///< of a correlation sum to a logarithm of likelihood
};

/// Over the places where a member lies now and the texture is known.
struct Overlap {
    double metres = 0;
    double texture_2 = 0; ///< sums of squares
    double signal_2 = 0;
    double product = 0;
};

Overlap overlap_of(const Member& member, const Values& texture) {
    Overlap overlap;
    for (std::size_t i = 0; i < texture.size(); ++i) {
        const auto r = static_cast<double>(texture[i]);
        const auto x = static_cast<double>(member.laid.x[i]);
        const bool both = r != 0 && member.laid.known[i] > 0;
        overlap.metres += both ? 1 : 0;
        overlap.texture_2 += both ? r * r : 0;
        overlap.signal_2 += both ? x * x : 0;
        overlap.product += r * x;
    }
    return overlap;
}

/// The highest sum of all blocks at one lag.
double best_at_one_lag(std::span<const Correlation> sums) {
    double best = 0;
    for (std::size_t lag = 0; lag < lag_count; ++lag) {
        double whole = 0;
        for (const auto& sum : sums) {
            whole += static_cast<double>(sum[lag]);
        }
        best = std::max(best, whole);
    }
    return best;
}

/// rho^2 of a correlation sum, as far as it is not chance; 0 if it may all be.
double sure_share(double product, double needed, double independent, const Overlap& overlap) {
    const double share = product * product / (overlap.texture_2 * overlap.signal_2);
    if (product <= 0 || share * independent < needed) {
        return 0;
    }
    return std::clamp((share * independent - 1) / std::max(1.0, independent - 1),
                      0.0,
                      most_agreement * most_agreement);
}

Agreement
agreement_of(const Member& member, const Values& texture, std::span<const Correlation> sums) {
    const auto overlap = overlap_of(member, texture);
    if (!(overlap.texture_2 > 0) || !(overlap.signal_2 > 0)) {
        return {0, 0};
    }
    const double independent = overlap.metres / member.independent_m;
    const double chosen =
        least_evidence + least_evidence_in_block * static_cast<double>(sums.size());
    const double share =
        std::max(sure_share(best_at_one_lag(sums), least_evidence, independent, overlap),
                 sure_share(overlap.product, chosen, independent, overlap));
    const double unit = std::sqrt(overlap.texture_2 / overlap.metres);
    return {share, std::sqrt(share) / (1 - share) / unit / member.independent_m};
}

/// Lays one member down where it agrees best with the others, which are all that is in `texture`.
Member placed(Member member, const Texture& texture, const AlignmentConfig& config) {
    const auto under = texture_under(texture, member);
    const auto sums = correlations(member, under);
    const auto agreement = agreement_of(member, under, sums);
    if (agreement.share > 0) {
        member.lag_m =
            best_lags(sums,
                      agreement.scale,
                      {member.place_sd_m, config.prior_dof, config.drift_m2_per_m * lag_block_m});
    } else {
        std::ranges::fill(member.lag_m, 0.0);
    }
    member.agreement = agreement.share;
    member.weight = static_cast<float>(std::sqrt(agreement.share) / (1 - agreement.share));
    member.precision = static_cast<float>(agreement.share / (1 - agreement.share));
    member.laid = laid_down(member);
    return member;
}

// ---------------------------------------------------------------------------------------- datum

/// Moves all that agree, so that their lags in each block have the mean 0.
void hold_datum(std::vector<Member>& members) {
    struct Block {
        double weights = 0;
        double sum = 0;
    };
    auto first = members.front().first_block;
    auto last = first;
    for (const auto& member : members) {
        first = std::min(first, member.first_block);
        last = std::max(last, member.first_block + static_cast<std::int32_t>(member.lag_m.size()));
    }
    std::vector<Block> blocks(static_cast<std::size_t>(last - first));
    for (const auto& member : members) {
        const double weight = member.agreement / (member.place_sd_m * member.place_sd_m);
        for (std::size_t b = 0; b < member.lag_m.size(); ++b) {
            auto& block = blocks[b + static_cast<std::size_t>(member.first_block - first)];
            block.weights += weight;
            block.sum += weight * member.lag_m[b];
        }
    }
    for (auto& member : members) {
        for (std::size_t b = 0; member.agreement > 0 && b < member.lag_m.size(); ++b) {
            const auto& block = blocks[b + static_cast<std::size_t>(member.first_block - first)];
            member.lag_m[b] = std::clamp(
                member.lag_m[b] - block.sum / block.weights, -1.0 * reach_m, 1.0 * reach_m);
        }
        member.laid = laid_down(member);
    }
}

Texture texture_of(std::span<const Member> members) {
    auto texture = bare_texture(members);
    for (const auto& member : members) {
        add(texture, member, 1);
    }
    return texture;
}

/// One after the other against those before: sharp from the first, whatever the places' errors.
void lay_first(std::vector<Member>& members, const AlignmentConfig& config) {
    auto texture = bare_texture(members);
    for (auto& member : members) {
        member = placed(std::move(member), texture, config);
        member.agreement = 1;
        member.weight = member.precision = static_cast<float>(seed_weight);
        add(texture, member, 1);
    }
}

void lay_again(std::vector<Member>& members, const AlignmentConfig& config) {
    auto texture = texture_of(members);
    for (auto& member : members) {
        add(texture, member, -1);
        member = placed(std::move(member), texture, config);
        add(texture, member, 1);
    }
}

LagLine line_of(const Member& member) {
    LagLine line{member.first_block, {}};
    for (const double lag : member.lag_m) {
        line.lag_cm.push_back(static_cast<std::int32_t>(std::lround(100 * lag)));
    }
    const bool moves = std::ranges::any_of(line.lag_cm, [](auto cm) { return cm != 0; });
    return moves ? line : LagLine{};
}

} // namespace

double lag_m(const LagLine& line, double station) {
    std::vector<double> lags_m(line.lag_cm.begin(), line.lag_cm.end());
    return line_at(lags_m, line.first_block, station) / 100;
}

std::vector<LagLine> lags_of(std::span<const StripTrace> traces, const AlignmentConfig& config) {
    if (traces.size() < 2) {
        return std::vector<LagLine>(traces.size());
    }
    std::vector<Member> members;
    members.reserve(traces.size());
    for (const auto& trace : traces) {
        assert(!trace.iri.empty());
        members.push_back(member_of(trace));
        members.back().laid = laid_down(members.back());
    }
    lay_first(members, config);
    for (int round = 0; round < config.rounds; ++round) {
        hold_datum(members);
        lay_again(members, config);
    }
    hold_datum(members);
    std::vector<LagLine> lines;
    for (const auto& member : members) {
        lines.push_back(line_of(member));
    }
    return lines;
}

} // namespace macadam
