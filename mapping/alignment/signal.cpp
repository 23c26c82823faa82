#include "mapping/alignment/signal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace macadam {
namespace {

// Agreement is sought at wavelengths of about 5 to 60 m: shorter ones are noise, longer ones depend
// on the speed and position of cars rather than on the road.
constexpr std::array<std::int32_t, 5> smoothing{1, 2, 3, 2, 1};
constexpr std::size_t smoothing_reach = smoothing.size() / 2;
constexpr std::size_t level_reach_m = 30;

// Fixed point with 14 fractional bits, until the standard deviation is known. Its product with a
// roughness (80,000 um/m) fits 32 bits.
constexpr std::int32_t one = 1 << 14;

constexpr std::size_t code_count = 256;

/// Reciprocals of small numbers with 16 fractional bits. That of 0 is 0.
template <std::size_t Count>
constexpr std::array<std::int32_t, Count> reciprocals() {
    std::array<std::int32_t, Count> parts{};
    for (std::size_t i = 1; i < Count; ++i) {
        parts[i] = static_cast<std::int32_t>((1 << 16) / i);
    }
    return parts;
}

/// \param sum  at most `count` times `one`
template <std::size_t Count>
std::int32_t
quotient(std::int32_t sum, std::int32_t count, const std::array<std::int32_t, Count>& parts) {
    return sum * parts[static_cast<std::size_t>(count)] >> 16;
}

std::optional<std::int32_t> median_um(const std::vector<RoughnessCode>& codes) {
    std::array<std::size_t, code_count> counts{};
    for (const auto code : codes) {
        ++counts[code];
    }
    const auto known = codes.size() - counts[no_roughness];
    std::size_t below = 0; // values increase with their codes
    for (std::size_t code = 0; code < no_roughness; ++code) {
        below += counts[code];
        if (below > known / 2) {
            return um_of(static_cast<RoughnessCode>(code));
        }
    }
    return std::nullopt;
}

/// Values padded on both sides, so that windows need no bounds checks.
struct Row {
    std::vector<std::int32_t> x;
    std::vector<std::int32_t> known; ///< 1 or 0
};

/// Computes (v - median) / (v + median): half the logarithm near the median, bounded by -1 and 1.
Row compressed(const std::vector<RoughnessCode>& codes) {
    std::array<std::int32_t, code_count> value{};
    const auto middle_um = median_um(codes).value_or(0);
    for (std::size_t code = 0; code < no_roughness; ++code) {
        const auto um = *um_of(static_cast<RoughnessCode>(code));
        value[code] = um + middle_um > 0 ? (um - middle_um) * one / (um + middle_um) : 0;
    }
    Row row{std::vector<std::int32_t>(codes.size() + 2 * smoothing_reach), {}};
    row.known = row.x;
    for (std::size_t i = 0; i < codes.size(); ++i) {
        row.x[i + smoothing_reach] = value[codes[i]];
        row.known[i + smoothing_reach] = codes[i] != no_roughness ? 1 : 0;
    }
    return row;
}

/// Smooths by a weighted mean of known neighbours and removes the padding.
Row smoothed(const Row& row) {
    static constexpr auto parts = reciprocals<10>(); // for sums of weights
    const auto count = row.x.size() - 2 * smoothing_reach;
    Row smooth{std::vector<std::int32_t>(count), std::vector<std::int32_t>(count)};
    for (std::size_t i = 0; i < count; ++i) {
        std::int32_t sum = 0;
        std::int32_t weights = 0;
        for (std::size_t k = 0; k < smoothing.size(); ++k) {
            sum += smoothing[k] * row.x[i + k];
            weights += smoothing[k] * row.known[i + k];
        }
        smooth.known[i] = row.known[i + smoothing_reach];
        smooth.x[i] = smooth.known[i] * quotient(sum, weights, parts);
    }
    return smooth;
}

/// Subtracts the running mean of known values within `level_reach_m`.
std::vector<std::int32_t> without_level(const Row& row) {
    static constexpr auto parts = reciprocals<2 * level_reach_m + 2>();
    const auto count = row.x.size();
    std::vector<std::int32_t> level(count);
    std::int32_t sum = 0; // over the window
    std::int32_t known = 0;
    for (std::size_t i = 0; i < count + level_reach_m; ++i) {
        if (i < count) {
            sum += row.x[i];
            known += row.known[i];
        }
        if (i > 2 * level_reach_m) {
            sum -= row.x[i - 2 * level_reach_m - 1];
            known -= row.known[i - 2 * level_reach_m - 1];
        }
        if (i >= level_reach_m) {
            const auto at = i - level_reach_m;
            level[at] = row.known[at] * (row.x[at] - quotient(sum, known, parts));
        }
    }
    return level;
}

/// Returns the factor, with 16 fractional bits, that scales the standard deviation to one unit; 0
/// if it is negligible.
std::int64_t scale_of(const std::vector<std::int32_t>& values,
                      const std::vector<std::int32_t>& known) {
    constexpr double min_sd = 1e-3 * one; // an even trace cannot be aligned
    std::int64_t square = 0;
    std::int64_t count = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        square += std::int64_t{values[i]} * values[i];
        count += known[i];
    }
    const double sd = std::sqrt(static_cast<double>(square) /
                                static_cast<double>(std::max<std::int64_t>(1, count)));
    return sd > min_sd ? static_cast<std::int64_t>(signal_unit * double{1 << 16} / sd) : 0;
}

} // namespace

Signal signal_of(const RoughnessTrace& trace) {
    const auto row = smoothed(compressed(trace.iri));
    const auto values = without_level(row);
    const auto scale = scale_of(values, row.known);
    const auto count = values.size();
    Signal signal{
        trace.first_m, std::vector<std::int16_t>(count), std::vector<std::int16_t>(count)};
    for (std::size_t i = 0; i < count; ++i) {
        const auto x = values[i] * scale >> 16;
        signal.x[i] =
            static_cast<std::int16_t>(std::clamp<std::int64_t>(x, -max_signal, max_signal));
        signal.known[i] = static_cast<std::int16_t>(-row.known[i]);
    }
    return signal;
}

std::int64_t dot(std::span<const std::int16_t> a, std::span<const std::int16_t> b) {
    constexpr std::size_t part = 256; // a sum of this many products fits 32 bits
    static_assert(std::int64_t{max_signal} * max_signal * part < (std::int64_t{1} << 31));
    std::int64_t sum = 0;
    for (std::size_t first = 0; first < a.size(); first += part) {
        const auto last = std::min(a.size(), first + part);
        std::int32_t partial = 0;
        for (std::size_t i = first; i < last; ++i) {
            partial += std::int32_t{a[i]} * b[i];
        }
        sum += partial;
    }
    return sum;
}

double independent_m(const std::vector<std::int16_t>& x) {
    constexpr std::size_t farthest_m = 15;
    const std::span<const std::int16_t> all{x};
    const auto whole = static_cast<double>(dot(all, all));
    double sum = 1;
    for (std::size_t lag = 1; whole > 0 && lag <= farthest_m && lag < x.size(); ++lag) {
        const double rho =
            static_cast<double>(dot(all.first(x.size() - lag), all.subspan(lag))) / whole;
        sum += 2 * rho * rho;
    }
    return sum;
}

} // namespace macadam
