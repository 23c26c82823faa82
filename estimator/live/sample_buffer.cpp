#include "estimator/live/sample_buffer.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace macadam {
namespace {

constexpr double forget_every_s = 10;
constexpr double infinity = std::numeric_limits<double>::infinity();

template <typename Value>
void drop_first(std::vector<Value>& values, std::ptrdiff_t count) {
    values.erase(values.begin(), values.begin() + count);
}

/// Counts the increasing times before from_s.
std::ptrdiff_t count_before(const std::vector<double>& t_s, double from_s) {
    return std::ranges::lower_bound(t_s, from_s) - t_s.begin();
}

void forget(TriaxialSamples& samples, double from_s) {
    const auto count = count_before(samples.t_s, from_s);
    drop_first(samples.t_s, count);
    drop_first(samples.x, count);
    drop_first(samples.y, count);
    drop_first(samples.z, count);
}

void forget(SpeedSamples& samples, double from_s) {
    const auto count = count_before(samples.t_s, from_s);
    drop_first(samples.t_s, count);
    drop_first(samples.speed_mps, count);
}

void forget(std::vector<GnssFix>& fixes, double from_s) {
    drop_first(fixes, std::ranges::lower_bound(fixes, from_s, {}, &GnssFix::t_s) - fixes.begin());
}

} // namespace

SampleBuffer::SampleBuffer(TripMeta meta, double vibration_s, double motion_s)
    : vibration_s_{vibration_s}, motion_s_{motion_s}, now_s_{-infinity}, forgot_s_{-infinity} {
    trip_.meta = std::move(meta);
}

void SampleBuffer::add(const TripLog& samples) {
    const auto add_triples = [this](const TriaxialSamples& from, auto& gate, TriaxialSamples& to) {
        for (std::size_t i = 0; i < from.t_s.size(); ++i) {
            const Triple triple{from.t_s[i], from.x[i], from.y[i], from.z[i]};
            gate.add(triple.t_s, triple, [&](const Triple& passed) {
                to.t_s.push_back(passed.t_s);
                to.x.push_back(passed.x);
                to.y.push_back(passed.y);
                to.z.push_back(passed.z);
                now_s_ = std::max(now_s_, passed.t_s);
            });
        }
    };
    add_triples(samples.acc, acc_, trip_.acc);
    add_triples(samples.gyro, gyro_, trip_.gyro);
    for (std::size_t i = 0; i < samples.speed.t_s.size(); ++i) {
        const Speed speed{samples.speed.t_s[i], samples.speed.speed_mps[i]};
        speed_.add(speed.t_s, speed, [&](const Speed& passed) {
            trip_.speed.t_s.push_back(passed.t_s);
            trip_.speed.speed_mps.push_back(passed.speed_mps);
            now_s_ = std::max(now_s_, passed.t_s);
        });
    }
    for (const auto& fix : samples.fixes) {
        fixes_.add(fix.t_s, fix, [&](const GnssFix& passed) {
            trip_.fixes.push_back(passed);
            now_s_ = std::max(now_s_, passed.t_s);
        });
    }
    if (now_s_ - forgot_s_ > forget_every_s) {
        forget();
    }
}

void SampleBuffer::forget() {
    forgot_s_ = now_s_;
    macadam::forget(trip_.acc, now_s_ - vibration_s_);
    macadam::forget(trip_.gyro, now_s_ - vibration_s_);
    macadam::forget(trip_.speed, now_s_ - motion_s_);
    macadam::forget(trip_.fixes, now_s_ - motion_s_);
}

TripLog SampleBuffer::motion_beside_vibration() const {
    const double from_s = now_s_ - vibration_s_;
    TripLog motion;
    motion.meta = trip_.meta;
    const auto first = count_before(trip_.speed.t_s, from_s);
    motion.speed.t_s.assign(trip_.speed.t_s.begin() + first, trip_.speed.t_s.end());
    motion.speed.speed_mps.assign(trip_.speed.speed_mps.begin() + first,
                                  trip_.speed.speed_mps.end());
    motion.fixes.assign(std::ranges::lower_bound(trip_.fixes, from_s, {}, &GnssFix::t_s),
                        trip_.fixes.end());
    return motion;
}

std::size_t SampleBuffer::dropped() const {
    return acc_.dropped() + gyro_.dropped() + speed_.dropped() + fixes_.dropped();
}

} // namespace macadam
