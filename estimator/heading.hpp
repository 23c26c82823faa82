#pragma once

#include "estimator/stretch.hpp"

#include <vector>

namespace macadam {

/// How far a car had turned about the vertical at each time, positive to the left, from its gyro.
/// Empty where the trip has none that can be believed.
struct Heading {
    double start_s = 0;
    double step_s = 0.1;
    std::vector<float> turned_rad; ///< since start_s, one each step_s
    std::vector<TimeSpan> silent;  ///< when turns were not measured, in order, not overlapping
    double bias_sd_radps = 0;      ///< of what is left of the gyro's bias
};

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
