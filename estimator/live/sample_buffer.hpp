#pragma once

#include "estimator/common/trip.hpp"
#include "estimator/live/monotonic_gate.hpp"

#include <cstddef>

namespace macadam {

/// Buffer of a trip's recent samples, sorted by sensor and kept for a limited time.
class SampleBuffer {
public:
    /// \param vibration_s  retention time of accelerations and rates of turn.
    /// \param motion_s     retention time of speeds and fixes. Older samples are removed from time
    ///                     to time.
    SampleBuffer(TripMeta meta, double vibration_s, double motion_s);

    /// \param samples  in order of arrival; its meta is ignored.
    void add(const TripLog& samples);

    /// Returns the kept samples; `rows` is empty.
    const TripLog& trip() const { return trip_; }

    /// Returns the trip with `fixes` and `speed` of the last vibration_s only, for fast processing.
    TripLog motion_beside_vibration() const;

    double now_s() const { return now_s_; } ///< latest time of any sample; initially -infinity
    std::size_t dropped() const;            ///< number of samples whose time did not increase

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
