#pragma once

#include "mapping/alignment/signal.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// Sums of all aligned signals of a chunk by position. Integers, so that subtracting an added
/// signal leaves no residue and the order does not matter.
struct SignalTemplate {
    std::int32_t first_m;
    std::vector<std::int64_t> sum;       ///< of signals times weight
    std::vector<std::int32_t> precision; ///< of known samples
};

/// Weight of a signal, in units of `weight_unit`.
struct SignalWeight {
    std::int32_t weight = 0;
    std::int32_t precision = 0;
};

inline constexpr std::int32_t weight_unit = 256;

/// Creates an empty template between two stations.
SignalTemplate empty_template(std::int32_t first_m, std::int32_t last_m);

/// Adds an aligned signal to the template; `sign` -1 subtracts it.
SignalTemplate with(SignalTemplate reference,
                    const Signal& shifted,
                    const SignalWeight& weight,
                    std::int32_t sign = 1);

/// Estimates the most likely profile signal from a station on, assuming that profile signals have
/// variance 1.
Signal profile_signal(const SignalTemplate& reference, std::int32_t first_m, std::size_t count);

} // namespace macadam
