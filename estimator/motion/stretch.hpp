#pragma once

#include "estimator/common/trip.hpp"
#include "estimator/common/trip_spans.hpp"
#include "estimator/motion/odometer.hpp"
#include "estimator/vehicle/vehicle.hpp"

#include <span>
#include <vector>

namespace macadam {

struct Mounting; // estimator/motion/mounting.hpp

struct StretchConfig {
    double rate_hz = 0; ///< of the even grid; 0: the log's own rate, at most max_rate_hz
    double max_rate_hz = 200;

    /// Not 0: a whole part of the log's own rate, the lowest that is at least enough_rate_hz and
    /// gives every metre driven so many samples.
    double samples_a_metre = 0;
    double enough_rate_hz = 48;
    double min_rate_hz = 40; ///< below it a log cannot carry the wavelengths that IRI weighs
    double min_speed_mps = 5;
    double max_gap_s = 0.06;    ///< longest hole in the vibration that is interpolated, ...
    double max_gap_steps = 2.5; ///< ... or this many of the log's own steps, if that is longer
    double min_length_m = 60;   ///< shorter ones would be all start-up
    double longest_s = 3600;    ///< cut there, to hold little memory
};

/// Where the trip went below `min_speed_mps` or backward, in order, not overlapping.
std::vector<TravelSpan> slow_parts(const Odometer& odometer, double min_speed_mps);

/// Where a stretch lies: samples [first, last] of trip.acc.
struct StretchSpan {
    std::size_t first;
    std::size_t last;
};

/// A part of a trip without gaps, at speed, on one even time grid. Sizes agree.
struct Stretch {
    double start_s;
    double step_s;
    std::vector<float> vertical_mps2; ///< vehicle's z, up, gravity removed; empty if not sampled
    std::vector<float> lateral_mps2;  ///< vehicle's y, left; empty if not sampled
    std::vector<float> roll_radps;    ///< about the vehicle's x; empty if not sampled throughout
    std::vector<float> pitch_radps;   ///< about y
    std::vector<float> yaw_radps;     ///< about z

    /// Standard deviation of a sample of roll and pitch that no car can have caused: what the gyro
    /// has at its highest frequencies, sensor noise and the shaking of its mount. 0: not known.
    double roll_noise_radps = 0;
    double pitch_noise_radps = 0;
    std::vector<float> speed_mps;
    std::vector<double> travel_m; ///< of the centre of gravity
};

/// Cuts a trip at gaps, stops, reversing and where no speed is known; says in `use.acc` why the
/// samples outside did not serve.
///
/// \param moved  when the sensor hung otherwise (Mounting::otherwise): nothing is made of it.
///
/// \throws InputError  if vibration was sampled slower than min_rate_hz.
std::vector<StretchSpan> find_stretches(const TripLog& trip,
                                        const Odometer& odometer,
                                        const StretchConfig& config,
                                        RowAudit& use,
                                        std::span<const TimeSpan> moved = {});

/// One stretch on its even grid: rotated by `mounting`, low-passed against aliasing where the grid
/// is coarser than the log, interpolated by a cubic. One at a time, to hold little memory.
Stretch make_stretch(const TripLog& trip,
                     const StretchSpan& span,
                     const Odometer& odometer,
                     const Mounting& mounting,
                     const StretchConfig& config);

} // namespace macadam
