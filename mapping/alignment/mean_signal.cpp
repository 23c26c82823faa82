#include "mapping/alignment/mean_signal.hpp"

#include <algorithm>

namespace macadam {

SignalTemplate bare_texture(std::int32_t first_m, std::int32_t last_m) {
    const auto count = static_cast<std::size_t>(last_m - first_m);
    return {first_m, std::vector<std::int64_t>(count), std::vector<std::int32_t>(count)};
}

SignalTemplate
with(SignalTemplate texture, const Signal& laid, const TextureWeight& weight, std::int32_t sign) {
    const auto first = static_cast<std::size_t>(laid.first_m - texture.first_m);
    for (std::size_t i = 0; i < laid.x.size(); ++i) {
        texture.sum[first + i] += sign * weight.weight * laid.x[i];
        texture.precision[first + i] += (sign * weight.precision) & laid.known[i];
    }
    return texture;
}

Signal texture_under(const SignalTemplate& texture, std::int32_t first_m, std::size_t count) {
    const auto first = static_cast<std::size_t>(first_m - texture.first_m);
    Signal under{first_m, std::vector<std::int16_t>(count), std::vector<std::int16_t>(count)};
    for (std::size_t i = 0; i < count; ++i) {
        const auto precision = texture.precision[first + i];
        // A single division of two integers gives the same result on every machine.
        const double x = static_cast<double>(texture.sum[first + i]) /
                         static_cast<double>(weight_unit + precision);
        under.x[i] =
            static_cast<std::int16_t>(std::clamp(x, double{-max_signal}, double{max_signal}));
        under.known[i] = static_cast<std::int16_t>(precision != 0 ? -1 : 0);
    }
    return under;
}

} // namespace macadam
