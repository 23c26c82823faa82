#include "estimator/live/live_mounting.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace macadam {
namespace {

constexpr double block_s = 0.25;           // the mounting uses four means per second
constexpr std::size_t max_blocks = 14'400; // an hour
constexpr double early_s = 60;             // initial time with more frequent updates
constexpr double early_every_s = 5;
constexpr double late_every_s = 30;
constexpr double infinity = std::numeric_limits<double>::infinity();

float mean_of(const std::vector<float>& values, std::ptrdiff_t from, std::ptrdiff_t to) {
    double sum = 0;
    int count = 0;
    for (auto i = from; i < to; ++i) {
        const float value = values[static_cast<std::size_t>(i)];
        sum += std::isnan(value) ? 0 : static_cast<double>(value);
        count += std::isnan(value) ? 0 : 1;
    }
    return count == 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(sum / count);
}

template <typename Value>
void keep_last(std::vector<Value>& values, std::size_t count) {
    if (values.size() > count) {
        values.erase(values.begin(), values.end() - static_cast<std::ptrdiff_t>(count));
    }
}

Mounting stated(const TripMeta& meta) {
    TripLog silent;
    silent.meta = meta;
    return estimate_mounting(silent, Odometer{{{0}, {0}, {0}, {0}}});
}

} // namespace

LiveMounting::LiveMounting(TripMeta meta)
    : taken_s_{-infinity}, next_s_{-infinity}, first_s_{infinity}, mounting_{stated(meta)} {
    felt_.meta = std::move(meta);
}

void LiveMounting::add(const TripLog& recent, const Odometer& odometer, double now_s) {
    const auto& t_s = recent.acc.t_s;
    auto from = std::ranges::upper_bound(t_s, taken_s_) - t_s.begin();
    while (from < std::ssize(t_s)) {
        const double begin_s = t_s[static_cast<std::size_t>(from)];
        const auto to = std::ranges::lower_bound(t_s, begin_s + block_s) - t_s.begin();
        if (to == std::ssize(t_s)) {
            break; // the block is incomplete
        }
        const double last_s = t_s[static_cast<std::size_t>(to - 1)];
        const double middle_s = (begin_s + last_s) / 2;
        felt_.acc.t_s.push_back(middle_s);
        felt_.acc.x.push_back(mean_of(recent.acc.x, from, to));
        felt_.acc.y.push_back(mean_of(recent.acc.y, from, to));
        felt_.acc.z.push_back(mean_of(recent.acc.z, from, to));
        motion_.t_s.push_back(middle_s);
        const double before_m = motion_.travel_m.empty() ? 0 : motion_.travel_m.back();
        motion_.travel_m.push_back(std::max(before_m, odometer.travel_m(middle_s)));
        motion_.speed_mps.push_back(static_cast<float>(odometer.speed_mps(middle_s)));
        motion_.reversing.push_back(odometer.reversing(middle_s) ? 1 : 0);
        taken_s_ = last_s;
        from = to;
    }
    if (motion_.t_s.empty() || now_s < next_s_) {
        return;
    }
    keep_last(felt_.acc.t_s, max_blocks);
    keep_last(felt_.acc.x, max_blocks);
    keep_last(felt_.acc.y, max_blocks);
    keep_last(felt_.acc.z, max_blocks);
    keep_last(motion_.t_s, max_blocks);
    keep_last(motion_.travel_m, max_blocks);
    keep_last(motion_.speed_mps, max_blocks);
    keep_last(motion_.reversing, max_blocks);
    mounting_ = estimate_mounting(felt_, Odometer{motion_});
    first_s_ = std::min(first_s_, now_s);
    next_s_ = now_s + (now_s - first_s_ < early_s ? early_every_s : late_every_s);
}

} // namespace macadam
