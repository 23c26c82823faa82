#pragma once

#include "estimator/events/event_detection.hpp"
#include "estimator/events/event_templates.hpp"

#include <span>
#include <vector>

namespace macadam {

/// Event in one wheel track.
struct TrackEvent {
    EventShape shape;
    double at_m;     ///< its middle, from the first station
    double length_m; ///< of the template that fits best; 0 for a step
    double size_mm;  ///< positive, but negative for a step down
    double sd_mm;
    double score;
};

/// Detects events in one wheel track.
///
/// \param profile_m  elevation at even stations
/// \param error_m    one draw of its error, of the same size; of another size: no events
/// \returns          in order along the track, at least 1 m apart
std::vector<TrackEvent> events_in_track(std::span<const float> profile_m,
                                        std::span<const float> error_m,
                                        double step_m,
                                        const EventConfig& config);

} // namespace macadam
