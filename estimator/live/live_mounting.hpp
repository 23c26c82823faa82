#pragma once

#include "estimator/motion/mounting.hpp"

namespace macadam {

/// Running estimate of the sensor's mounting from quarter-second means of the last hour. Levelling
/// is accurate to about two degrees after half a minute of driving; the heading, where it must be
/// estimated at all, requires braking or accelerating eight times.
class LiveMounting {
public:
    explicit LiveMounting(TripMeta meta);

    /// Adds the samples since the last call and periodically updates the mounting.
    ///
    /// \param recent    reaches back to the last call.
    /// \param odometer  reaches to now_s.
    void add(const TripLog& recent, const Odometer& odometer, double now_s);

    const Mounting& mounting() const { return mounting_; }

private:
    TripLog felt_; ///< means, in acc only
    Odometer::Knots motion_;
    double taken_s_;
    double next_s_;
    double first_s_;
    Mounting mounting_;
};

} // namespace macadam
