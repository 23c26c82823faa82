#pragma once

#include "estimator/common/trip.hpp"
#include "estimator/common/trip_spans.hpp"
#include "estimator/motion/odometer.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace macadam {

struct Mounting; // estimator/motion/mounting.hpp

/// Heading change of a car about the vertical over time, positive to the left, from its gyro. Empty
/// if the trip has no usable gyro.
///
/// Values lie on a grid of step_s. A long silence has values only at its ends, so that memory is
/// proportional to the measurements and not to the clock time.
struct Heading {
    /// Values of consecutive steps: those of turned_rad from `first` up to the next run's.
    struct Run {
        std::int64_t first_step; ///< counted from start_s
        std::size_t first;
    };

    double start_s = 0;
    double step_s = 0.1;
    std::vector<float> turned_rad; ///< since start_s, run after run
    std::vector<Run> runs;         ///< in order of time; at least one where there are values
    std::vector<TimeSpan> silent;  ///< times without measured turns, in order, not overlapping
    double bias_sd_radps = 0;      ///< of the remaining gyro bias
};

/// Returns the run that contains a step, or the one before the silence that contains it.
std::vector<Heading::Run>::const_iterator run_at(const Heading& heading, double step);

/// Returns the number of values in a run.
std::size_t size_of(const Heading& heading, std::vector<Heading::Run>::const_iterator run);

/// Returns the turn since start_s, held before and after the data; silences add zero.
double turned_at(const Heading& heading, double t_s);

struct Turn {
    double rad;    ///< positive to the left
    double sd_rad; ///< infinite if part of the turn was not measured
};

/// Returns the turn from one time to a later one.
Turn turned(const Heading& heading, double from_s, double to_s);

/// Integrates the yaw rate about the vehicle's vertical, less its bias.
///
/// The bias drifts slowly. It is observed while the car stands, and while it drives as the
/// difference from the receiver's course (or, without one, the course between positions) over spans
/// of 20 s and more. A random walk, smoothed forward and backward, weights these observations.
///
/// \returns  an empty heading if the trip has no gyro, or if the gyro contradicts the course of
///           most spans: wrong unit, wrong axis, or dead.
Heading make_heading(const TripLog& trip, const Odometer& odometer, const Mounting& mounting);

} // namespace macadam
