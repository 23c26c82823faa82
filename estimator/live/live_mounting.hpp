#pragma once

#include "estimator/motion/mounting.hpp"

#include <cstddef>
#include <optional>

namespace macadam {

/// How the sensor hangs, by what it felt so far: means of quarters of a second over the last hour.
/// Level is good to about two degrees after half a minute of driving; the heading, where it is to
/// be found at all, takes eight times braking or driving off.
class LiveMounting {
public:
    explicit LiveMounting(TripMeta meta);

    /// Takes what came since the last call, and finds the mounting again now and then.
    ///
    /// \param recent    reaches back to the last call.
    /// \param odometer  reaches to now_s.
    void add(const TripLog& recent, const Odometer& odometer, double now_s);

    const Mounting& mounting() const { return mounting_; }

private:
    TripLog felt_; ///< its acc alone: the means
    Odometer::Knots motion_;
    double taken_s_;
    double next_s_;
    double first_s_;
    Mounting mounting_;
};

} // namespace macadam
