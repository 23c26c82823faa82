#pragma once

#include "estimator/common/trip.hpp"
#include "estimator/live/monotonic_gate.hpp"

#include <cstddef>

namespace macadam {

/// What a trip's sensors said of late, put in order as it comes, and for how long it is kept.
class SampleBuffer {
public:
    /// \param vibration_s  what is kept of accelerations and rates of turn, ...
    /// \param motion_s     ... of speeds and fixes; what is older goes now and then.
    SampleBuffer(TripMeta meta, double vibration_s, double motion_s);

    /// \param samples  in the order in which they came; its meta is not looked at.
    void add(const TripLog& samples);

    /// Of the kept samples; its `rows` are empty.
    const TripLog& trip() const { return trip_; }

    /// With `fixes` and `speed` of the last vibration_s only, to be measured quickly.
    TripLog motion_beside_vibration() const;

    double now_s() const { return now_s_; } ///< the latest time of any sample; -infinity before
    std::size_t dropped() const;            ///< samples whose times did not rise

    TripMeta& meta() { return trip_.meta; }

private:
    struct Triple {
        double t_s;
        float x, y, z;
    };
    struct Speed {
        double t_s;
        float speed_mps;
    };

    void forget();

    double vibration_s_;
    double motion_s_;
    TripLog trip_;
    MonotonicGate<Triple> acc_, gyro_;
    MonotonicGate<Speed> speed_;
    MonotonicGate<GnssFix> fixes_;
    double now_s_;
    double forgot_s_;
};

} // namespace macadam
