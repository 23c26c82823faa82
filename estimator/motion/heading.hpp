#pragma once

#include "estimator/common/trip.hpp"
#include "estimator/common/trip_spans.hpp"
#include "estimator/motion/odometer.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace macadam {

struct Mounting; // estimator/motion/mounting.hpp

/// How far a car had turned about the vertical at each time, positive to the left, from its gyro.
/// Empty where the trip has none that can be believed.
///
/// Values stand on a grid of step_s. Within a long silence there are none but at its ends, so that
/// memory goes with what was measured and not with what a clock says.
struct Heading {
    /// Values of consecutive steps: those of turned_rad from `first` to before the next run's.
    struct Run {
        std::int64_t first_step; ///< counted from start_s
        std::size_t first;
    };

    double start_s = 0;
    double step_s = 0.1;
    std::vector<float> turned_rad; ///< since start_s, run after run
    std::vector<Run> runs;         ///< in the order of time; at least one where there are values
    std::vector<TimeSpan> silent;  ///< when turns were not measured, in order, not overlapping
    double bias_sd_radps = 0;      ///< of what is left of the gyro's bias
};

/// The run that holds a step, or the one before the silence that holds it.
std::vector<Heading::Run>::const_iterator run_at(const Heading& heading, double step);

/// The number of values in a run.
std::size_t size_of(const Heading& heading, std::vector<Heading::Run>::const_iterator run);

/// The turn since start_s, held before and after; across silences nothing is added.
double turned_at(const Heading& heading, double t_s);

struct Turn {
    double rad;    ///< positive to the left
    double sd_rad; ///< infinite where not all of it was measured
};

/// The turn from one time to a later one.
Turn turned(const Heading& heading, double from_s, double to_s);

/// Integrates the rate about the vehicle's vertical, less its bias.
///
/// The bias wanders slowly; it is seen where the car stands, and while it drives as the difference
/// from the receiver's course (failing that the course from place to place) over spans of 20 s and
/// more. A random walk smoothed forward and backward weighs them.
///
/// \returns  nothing if the trip has no gyro, or if it contradicts the course of most spans:
/// another
///           unit, another axis, dead.
Heading make_heading(const TripLog& trip, const Odometer& odometer, const Mounting& mounting);

} // namespace macadam
