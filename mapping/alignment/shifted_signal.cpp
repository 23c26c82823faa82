#include "mapping/alignment/shifted_signal.hpp"

#include <algorithm>

namespace macadam {
namespace {

constexpr auto block_length = static_cast<std::int32_t>(lag_block_m);
static_assert(block_length == lag_block_m && block_length % 2 == 0);

constexpr int point = 16; // fractional bits of lags in metres

std::int32_t fixed(std::int32_t cm) {
    return cm * (1 << point) / 100;
}

/// A lag that changes linearly from metre to metre.
struct Slope {
    std::int32_t lag; ///< at the centre of the first metre
    std::int32_t step;
};

/// Returns the number of metres until the integer part of the lag changes.
std::size_t metres_alike(const Slope& slope) {
    constexpr std::int32_t metre = 1 << point;
    const auto part = slope.lag & (metre - 1);
    const auto left = slope.step > 0   ? (metre - part + slope.step - 1) / slope.step
                      : slope.step < 0 ? part / -slope.step + 1
                                       : metre;
    return static_cast<std::size_t>(left);
}

/// Fills cells [first, last) of `shifted`, in runs of equal integer lag.
void shift_cells(
    const Signal& from, std::size_t first, std::size_t last, Slope slope, Signal& shifted) {
    constexpr int fine = 7; // fractional bits within a metre
    while (first < last) {
        const auto run = std::min(last - first, metres_alike(slope));
        const auto at = static_cast<std::size_t>(static_cast<std::int32_t>(first) + pad_m -
                                                 reach_m + (slope.lag >> point));
        const auto* const x = from.x.data() + at;
        const auto* const known = from.known.data() + at;
        auto* const to_x = shifted.x.data() + first;
        auto* const to_known = shifted.known.data() + first;
        for (std::size_t i = 0; i < run; ++i) {
            const auto lag = slope.lag + static_cast<std::int32_t>(i) * slope.step;
            const auto share = (lag >> (point - fine)) & ((1 << fine) - 1);
            const auto between = (x[i] * ((1 << fine) - share) + x[i + 1] * share) >> fine;
            to_known[i] = static_cast<std::int16_t>(known[i] & known[i + 1]);
            to_x[i] = static_cast<std::int16_t>(between & to_known[i]);
        }
        first += run;
        slope.lag += static_cast<std::int32_t>(run) * slope.step;
    }
}

} // namespace

std::int32_t block_of(std::int32_t metre) {
    return metre >= 0 ? metre / block_length : -((block_length - 1 - metre) / block_length);
}

Signal padded(const Signal& signal) {
    const auto count = signal.x.size() + std::size_t{2} * pad_m + slack_m;
    Signal wide{signal.first_m, std::vector<std::int16_t>(count), std::vector<std::int16_t>(count)};
    std::ranges::copy(signal.x, wide.x.begin() + pad_m);
    std::ranges::copy(signal.known, wide.known.begin() + pad_m);
    return wide;
}

Signal shifted_signal(const Signal& signal,
                      std::int32_t first_block,
                      std::span<const std::int32_t> lag_cm) {
    const auto count =
        signal.x.size() - std::size_t{2} * pad_m - slack_m + std::size_t{2} * reach_m;
    Signal shifted{signal.first_m - reach_m,
                   std::vector<std::int16_t>(count),
                   std::vector<std::int16_t>(count)};
    const auto cell_of = [&](std::int32_t metre) {
        return static_cast<std::size_t>(
            std::clamp<std::int64_t>(metre - shifted.first_m, 0, static_cast<std::int64_t>(count)));
    };
    auto middle = first_block * block_length + block_length / 2;
    std::size_t done = cell_of(middle);
    shift_cells(signal, 0, done, {fixed(lag_cm.front()), 0}, shifted);
    for (std::size_t b = 1; b < lag_cm.size(); ++b, middle += block_length) {
        const auto lag = fixed(lag_cm[b - 1]);
        const auto step = (fixed(lag_cm[b]) - lag) / block_length;
        const auto last = cell_of(middle + block_length);
        const auto begun = shifted.first_m + static_cast<std::int32_t>(done) - middle;
        shift_cells(signal, done, last, {lag + begun * step + step / 2, step}, shifted);
        done = last;
    }
    shift_cells(signal, done, count, {fixed(lag_cm.back()), 0}, shifted);
    return shifted;
}

} // namespace macadam
