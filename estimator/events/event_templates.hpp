#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// Shape of a local defect in the profile of one wheel track.
enum class EventShape : std::uint8_t {
    dip,   ///< below the road on both sides
    raise, ///< above the road on both sides
    step,  ///< up or down, between two levels
};

/// Matched filter for one shape and length.
struct EventTemplate {
    EventShape shape;
    double length_m; ///< of the dip or raise; 0 for a step

    /// Changes from station to station of the shape of size 1: the shape whitened for a road whose
    /// elevation is a random walk, as the smoother's prior has it.
    std::vector<double> change;
};

/// Returns templates of all shapes and lengths: dips of 0.5 to 1.5 m, raises of 0.5 to 4 m, both
/// of the form of one wave of a cosine, averaged over the step, and steps.
///
/// \param step_m  distance of stations, 0.05 to 0.25
std::vector<EventTemplate> event_templates(double step_m);

/// Correlates a template with the changes of a profile.
///
/// \returns  per station the size of the shape that begins there, in the unit of the profile, as
///           the least-squares fit has it; positive for the template's shape, for steps of either
///           sign. The last stations, where the template would reach beyond the end, are 0.
std::vector<double> template_sizes(const EventTemplate& shape, std::span<const float> profile_m);

/// Fits the front and the rear half of a dip or raise alone, at a station of template_sizes.
/// \returns  the smaller size of both: an edge of something longer has one half only
double smaller_half(const EventTemplate& shape, std::span<const float> profile_m, std::size_t at);

} // namespace macadam
