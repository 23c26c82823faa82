#pragma once

#include "mapping/alignment/signal.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// What all laid signals say of a chunk's texture: sums by place. Whole numbers: what was added and
/// taken away again leaves nothing behind, and the order does not matter.
struct SignalTemplate {
    std::int32_t first_m;
    std::vector<std::int64_t> sum;       ///< of signals times weight
    std::vector<std::int32_t> precision; ///< of what is known
};

/// How much a signal counts, in parts of `weight_unit`.
struct TextureWeight {
    std::int32_t weight = 0;
    std::int32_t precision = 0;
};

inline constexpr std::int32_t weight_unit = 256;

/// Nothing yet, between two stations.
SignalTemplate bare_texture(std::int32_t first_m, std::int32_t last_m);

/// With a laid signal added; `sign` -1 takes it away.
SignalTemplate with(SignalTemplate texture,
                    const Signal& laid,
                    const TextureWeight& weight,
                    std::int32_t sign = 1);

/// The most likely texture from a station on, if textures have variance 1.
Signal texture_under(const SignalTemplate& texture, std::int32_t first_m, std::size_t count);

} // namespace macadam
