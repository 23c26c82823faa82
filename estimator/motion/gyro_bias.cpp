#include "estimator/motion/gyro_bias.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace macadam {
namespace {

constexpr double prior_bias_sd_radps = 0.02;        // 1 degree per second: not calibrated
constexpr double bias_walk_radps_per_sqrt_s = 5e-5; // with temperature: 0.003 rad/s in an hour
constexpr double block_s = 10;                      // the bias is constant within a block
constexpr double longest_drift_s = 3600;
constexpr double far_off = 3; // sds; readings farther off are weighted down

struct BiasEstimate {
    double mean;
    double variance;
};

BiasEstimate updated(const BiasEstimate& estimate, const BiasReading& reading) {
    const double off = reading.radps - estimate.mean;
    const double expected = estimate.variance + reading.variance;
    const double excess = off * off / (far_off * far_off * expected);
    const double variance = reading.variance + std::max(0.0, excess - 1) * expected;
    const double gain = estimate.variance / (estimate.variance + variance);
    return {estimate.mean + gain * off, (1 - gain) * estimate.variance};
}

/// Estimate of the bias in a block; the first block begins at start_s.
struct Block {
    std::int64_t number;
    BiasEstimate bias;
};

std::int64_t block_of(const Heading& heading, std::int64_t step) {
    return step / std::llround(block_s / heading.step_s);
}

/// Returns the blocks that contain values.
std::vector<Block> blocks_of(const Heading& heading) {
    std::vector<Block> blocks;
    for (auto run = heading.runs.begin(); run != heading.runs.end(); ++run) {
        const auto size = static_cast<std::int64_t>(size_of(heading, run));
        const auto last = block_of(heading, run->first_step + size - 1);
        auto number = block_of(heading, run->first_step);
        for (number += !blocks.empty() && blocks.back().number == number ? 1 : 0; number <= last;
             ++number) {
            blocks.push_back({number, {}});
        }
    }
    return blocks;
}

/// Smooths the bias over the blocks; it continues its random walk over silences.
std::vector<Block> smoothed_bias(const Heading& heading, std::vector<BiasReading> readings) {
    std::ranges::sort(readings, {}, &BiasReading::t_s);
    constexpr double walk_a_block =
        bias_walk_radps_per_sqrt_s * bias_walk_radps_per_sqrt_s * block_s;
    auto blocks = blocks_of(heading);
    const auto walk_to = [&](std::size_t i) {
        return walk_a_block * static_cast<double>(blocks[i].number - blocks[i - 1].number);
    };
    BiasEstimate estimate{0, prior_bias_sd_radps * prior_bias_sd_radps};
    auto next = readings.begin();
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        estimate.variance += i > 0 ? walk_to(i) : 0;
        const double until_s =
            heading.start_s + static_cast<double>(blocks[i].number + 1) * block_s;
        for (; next != readings.end() && next->t_s < until_s; ++next) {
            estimate = updated(estimate, *next);
        }
        blocks[i].bias = estimate;
    }
    for (auto i = blocks.size() - 1; i-- > 0;) {
        auto& earlier = blocks[i].bias;
        const auto& later = blocks[i + 1].bias;
        const double walk = walk_to(i + 1);
        const double gain = earlier.variance / (earlier.variance + walk);
        earlier.mean += gain * (later.mean - earlier.mean);
        earlier.variance += gain * gain * (later.variance - earlier.variance - walk);
    }
    return blocks;
}

/// Subtracts the bias. Between two runs the mean of the biases at their ends applies; over a long
/// silence it is not subtracted, since the rounding of floats would then hide turns.
Heading without_bias(Heading heading, const std::vector<Block>& blocks) {
    double bias_rad = 0;
    double variance = 0;
    auto block = blocks.begin();
    auto last = block->bias;
    for (auto run = heading.runs.cbegin(); run != heading.runs.cend(); ++run) {
        const auto size = size_of(heading, run);
        for (std::size_t i = 0; i < size; ++i) {
            const auto number = block_of(heading, run->first_step + static_cast<std::int64_t>(i));
            while (block->number < number) {
                ++block;
            }
            const auto& estimate = block->bias;
            if (i == 0 && run != heading.runs.cbegin()) {
                const auto before = run - 1;
                const auto steps = static_cast<double>(run->first_step - before->first_step) -
                                   static_cast<double>(size_of(heading, before)); // without a value
                const double drift_s = heading.step_s * steps;
                bias_rad +=
                    drift_s < longest_drift_s ? (last.mean + estimate.mean) / 2 * drift_s : 0;
                variance += (last.variance + estimate.variance) / 2 * steps;
            }
            const auto at = run->first + i;
            bias_rad += at > 0 ? estimate.mean * heading.step_s : 0;
            variance += estimate.variance;
            heading.turned_rad[at] -= static_cast<float>(bias_rad);
            last = estimate;
        }
    }
    const auto end = heading.runs.cend() - 1;
    const auto steps = end->first_step + static_cast<std::int64_t>(size_of(heading, end));
    heading.bias_sd_radps = std::sqrt(variance / static_cast<double>(steps));
    return heading;
}

} // namespace

Heading without_gyro_bias(Heading heading, std::vector<BiasReading> readings) {
    const auto blocks = smoothed_bias(heading, std::move(readings));
    return without_bias(std::move(heading), blocks);
}

} // namespace macadam
