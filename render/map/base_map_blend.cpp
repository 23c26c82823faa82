#include "render/map/base_map_blend.hpp"

#include <cmath>
#include <utility>

namespace macadam {

PaintPart ground_with(PaintPart base, const GroundMix& mix) {
    // Integers make the rounding equal on every machine; 255 times `all` and its half fit 32 bits.
    constexpr std::uint32_t whole = 65536;
    constexpr std::uint32_t all = 255 * whole;
    const auto opacity = std::uint32_t(std::lround(mix.opacity * double(whole)));
    return [base = std::move(base), ground = mix.ground, opacity](const PicturePart& part) {
        auto rgba = base(part);
        for (std::size_t at = 0; at < rgba.size(); at += 4) {
            const std::uint32_t seen = rgba[at + 3] * opacity;
            for (unsigned i = 0; i < 3; ++i) {
                const std::uint32_t behind = ground >> (16 - 8 * i) & 255U;
                auto& channel = rgba[at + i];
                channel = std::uint8_t((behind * (all - seen) + channel * seen + all / 2) / all);
            }
            rgba[at + 3] = 255;
        }
        return rgba;
    };
}

} // namespace macadam
