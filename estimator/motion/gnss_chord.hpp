#pragma once

#include "estimator/common/trip.hpp"

#include <vector>

namespace macadam {

/// Chord between two fixes, long enough that its course is known in spite of their noise.
struct GnssChord {
    double from_s; ///< time stamps of the fixes
    double to_s;
    double length_m;
    double course_rad; ///< positive to the left
};

/// Returns chords from fix to fix, each as short as possible.
///
/// \param max_duration_s  A chord between fixes farther apart in time is left out.
std::vector<GnssChord> gnss_chords(const TripLog& trip, double min_length_m, double max_duration_s);

} // namespace macadam
