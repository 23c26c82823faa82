#include "estimator/events/road_event.hpp"

namespace macadam {

Severity severity_of(double size_mm) {
    return size_mm < moderate_mm ? Severity::low
           : size_mm <= high_mm  ? Severity::moderate
                                 : Severity::high;
}

std::string_view name_of(EventKind kind) {
    switch (kind) {
    case EventKind::pothole:
        return "pothole";
    case EventKind::bump:
        return "bump";
    case EventKind::joint:
        return "joint";
    case EventKind::rail:
        break;
    }
    return "rail";
}

std::string_view name_of(WheelTrack track) {
    switch (track) {
    case WheelTrack::left:
        return "left";
    case WheelTrack::right:
        return "right";
    case WheelTrack::both:
        return "both";
    case WheelTrack::unknown:
        break;
    }
    return "unknown";
}

std::string_view name_of(Severity severity) {
    switch (severity) {
    case Severity::low:
        return "low";
    case Severity::moderate:
        return "moderate";
    case Severity::high:
        break;
    }
    return "high";
}

} // namespace macadam
