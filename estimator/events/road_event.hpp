#pragma once

#include <cstdint>
#include <string_view>

namespace macadam {

enum class EventKind : std::uint8_t {
    pothole, ///< hole of up to 1.5 m
    bump,    ///< raised part of up to 4 m
    joint,   ///< line across the lane: a step, or a groove or ridge of half a metre at most
    rail,    ///< two such lines at the distance of a pair of rails
};

/// Wheel track of an event.
enum class WheelTrack : std::uint8_t {
    unknown, ///< only the mean of both tracks was observed
    left,
    right,
    both,
};

enum class Severity : std::uint8_t { low, moderate, high };

/// Local defect of the road in one drive.
struct RoadEvent {
    EventKind kind;
    WheelTrack track;
    double travel_m; ///< of its middle, as IriRun's
    double length_m; ///< of the hole or raised part, coarsely; 0 for a step

    /// Depth of a pothole, height of a bump or step, depth or height of a groove or ridge, always
    /// positive; of the deeper track, or of the mean of both if the track is unknown. Averaged over
    /// 0.25 m, as a tyre does.
    double size_mm;
    double sd_mm; ///< of size_mm
    double score; ///< size over the standard deviation that road and estimate have there
};

/// Depths at which a pothole becomes moderate and high: J. S. Miller, W. Y. Bellinger, "Distress
/// Identification Manual for the Long-Term Pavement Performance Program", FHWA-HRT-13-092 (2014),
/// distress ACP 8. It has none for bumps, joints and rails, so the same are used.
inline constexpr double moderate_mm = 25, high_mm = 50;

Severity severity_of(double size_mm);

std::string_view name_of(EventKind kind);
std::string_view name_of(WheelTrack track);
std::string_view name_of(Severity severity);

} // namespace macadam
