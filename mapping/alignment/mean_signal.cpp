#include "mapping/alignment/mean_signal.hpp"

#include <algorithm>

namespace macadam {

SignalTemplate empty_template(std::int32_t first_m, std::int32_t last_m) {
    const auto count = static_cast<std::size_t>(last_m - first_m);
    return {first_m, std::vector<std::int64_t>(count), std::vector<std::int32_t>(count)};
}

SignalTemplate with(SignalTemplate reference,
                    const Signal& shifted,
                    const SignalWeight& weight,
                    std::int32_t sign) {
    const auto first = static_cast<std::size_t>(shifted.first_m - reference.first_m);
    for (std::size_t i = 0; i < shifted.x.size(); ++i) {
        // 32 bits suffice, because the weight of max_agreement times max_signal is far below.
        reference.sum[first + i] += static_cast<std::int64_t>(sign * weight.weight * shifted.x[i]);
        reference.precision[first + i] += (sign * weight.precision) & shifted.known[i];
    }
    return reference;
}

Signal profile_signal(const SignalTemplate& reference, std::int32_t first_m, std::size_t count) {
    const auto first = static_cast<std::size_t>(first_m - reference.first_m);
    Signal under{first_m, std::vector<std::int16_t>(count), std::vector<std::int16_t>(count)};
    for (std::size_t i = 0; i < count; ++i) {
        const auto precision = reference.precision[first + i];
        // A single division of two integers gives the same result on every machine.
        const double x = static_cast<double>(reference.sum[first + i]) /
                         static_cast<double>(weight_unit + precision);
        under.x[i] =
            static_cast<std::int16_t>(std::clamp(x, double{-max_signal}, double{max_signal}));
        under.known[i] = static_cast<std::int16_t>(precision != 0 ? -1 : 0);
    }
    return under;
}

} // namespace macadam
