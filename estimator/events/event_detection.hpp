#pragma once

#include "estimator/events/road_event.hpp"
#include "estimator/roughness/roughness_trace.hpp"

#include <vector>

namespace macadam {

/// Thresholds of detection. On a measured motorway, what one car called a pothole of 10 to 13 mm
/// others mostly called something else (docs/method/events.md).
struct EventConfig {
    double min_score = 6;    ///< standard deviations of road and estimate
    double min_hole_mm = 15; ///< of potholes and bumps
    double min_line_mm = 5;  ///< of joints that are steps

    /// The same in the mean of both tracks, where a hole in one track has half its depth.
    double min_mean_hole_mm = 10;
};

/// Detects potholes, bumps, joints and rails in the profile that the smoother estimated.
///
/// Matched filters for dips, raises and steps of several lengths run over each wheel track. The
/// response of each is divided by its standard deviation: that of the road itself, from the median
/// response within 25 m, and that of the estimate, from a draw of its error. So a rough road, or
/// one that was hardly observed, gives no alarms. Of responses that overlap the highest remains;
/// smaller ones beside a large event are its echo and are dropped.
///
/// \param profile  of the smoother, with its errors; the mean of both tracks serves where the
///                 tracks were not observed. Empty, or without errors: no events.
/// \returns        in order of travel
std::vector<RoadEvent> detect_events(const EstimatedProfile& profile,
                                     const EventConfig& config = {});

} // namespace macadam
