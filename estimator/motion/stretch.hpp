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

    /// If not 0: an integer fraction of the log's own rate, the lowest that is at least
    /// enough_rate_hz and gives this many samples per metre driven.
    double samples_a_metre = 0;
    double enough_rate_hz = 48;
    double min_rate_hz = 40; ///< minimum rate that resolves the wavelengths that dominate IRI
    double min_speed_mps = 5;
    double max_gap_s = 0.06;    ///< longest gap in the vibration that is interpolated, ...
    double max_gap_steps = 2.5; ///< ... or this many of the log's own steps, if that is longer
    double min_length_m = 60;   ///< shorter stretches consist of start-up only
    double longest_s = 3600;    ///< longer stretches are cut, to limit memory
};

/// Returns the median step of time stamps, s. At least two.
double median_step_s(const std::vector<double>& t_s);

/// Returns the travel intervals below `min_speed_mps` or in reverse, in order, not overlapping.
std::vector<TravelSpan> slow_parts(const Odometer& odometer, double min_speed_mps);

/// Samples [first, last] of trip.acc that form a stretch.
struct StretchSpan {
    std::size_t first;
    std::size_t last;
};

/// Stretches of a trip, in order, and the samples of trip.acc that are in one.
struct FoundStretches {
    std::vector<StretchSpan> spans;
    SampleUse acc;
};

/// Part of a trip without gaps, at speed, on one even time grid. Sizes agree.
struct Stretch {
    double start_s;
    double step_s;
    std::vector<float> vertical_mps2; ///< vehicle's z, up, gravity removed; empty if not sampled
    std::vector<float> lateral_mps2;  ///< vehicle's y, left; empty if not sampled
    std::vector<float> roll_radps;    ///< about the vehicle's x; empty if not sampled throughout
    std::vector<float> pitch_radps;   ///< about y
    std::vector<float> yaw_radps;     ///< about z

    /// Standard deviation of a sample of roll and pitch that no car can cause: the content of the
    /// gyro at its highest frequencies, from sensor noise and vibration of its mount. 0: not known.
    double roll_noise_radps = 0;
    double pitch_noise_radps = 0;
    std::vector<float> speed_mps;
    std::vector<double> travel_m; ///< of the centre of gravity
};

/// Cuts a trip at gaps, stops, reversing and unknown speed.
///
/// \param moved  times with another sensor orientation (Mounting::otherwise), which are excluded.
///
/// \throws InputError  if vibration was sampled slower than min_rate_hz.
FoundStretches find_stretches(const TripLog& trip,
                              const Odometer& odometer,
                              const StretchConfig& config,
                              std::span<const TimeSpan> moved = {});

/// Builds one stretch on its even grid: rotated by `mounting`, low-passed against aliasing where
/// the grid is coarser than the log, and interpolated by a cubic. Stretches are built one by one to
/// limit memory.
Stretch make_stretch(const TripLog& trip,
                     const StretchSpan& span,
                     const Odometer& odometer,
                     const Mounting& mounting,
                     const StretchConfig& config);

} // namespace macadam
