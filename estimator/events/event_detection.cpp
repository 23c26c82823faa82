#include "estimator/events/event_detection.hpp"

#include "estimator/events/track_events.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

// Responses of both tracks that belong to one event.
constexpr double same_place_m = 0.75;
constexpr double both_tracks = 0.5; // part of the larger size; below it, cross-talk of the tracks

constexpr double line_length_m = 0.5; // longest groove or ridge

// Rails of standard gauge are 1.435 m apart, more along a road that crosses them at an angle.
constexpr double min_rails_m = 1.2, max_rails_m = 2.1;
constexpr double alike_rails = 0.5; // smaller over larger

/// Event of the lane before it has a kind.
struct LaneEvent {
    TrackEvent event; ///< of the deeper track
    WheelTrack track;
};

double magnitude_mm(const TrackEvent& event) {
    return std::abs(event.size_mm);
}

/// Returns the larger of two events of the left and the right track, with the track.
LaneEvent joined(const TrackEvent& left, const TrackEvent& right) {
    const auto& [smaller, larger] =
        magnitude_mm(left) < magnitude_mm(right) ? std::pair{left, right} : std::pair{right, left};
    const bool both = smaller.shape == larger.shape &&
                      magnitude_mm(smaller) >= both_tracks * magnitude_mm(larger);
    const auto alone =
        magnitude_mm(left) < magnitude_mm(right) ? WheelTrack::right : WheelTrack::left;
    return {larger, both ? WheelTrack::both : alone};
}

/// Joins the events of both tracks, each in order along the road.
std::vector<LaneEvent> joined(const std::vector<TrackEvent>& left,
                              const std::vector<TrackEvent>& right) {
    std::vector<LaneEvent> lane;
    auto l = left.begin();
    auto r = right.begin();
    while (l != left.end() || r != right.end()) {
        if (l != left.end() && r != right.end() && std::abs(l->at_m - r->at_m) <= same_place_m) {
            lane.push_back(joined(*l++, *r++));
        } else if (r == right.end() || (l != left.end() && l->at_m < r->at_m)) {
            lane.push_back({*l++, WheelTrack::left});
        } else {
            lane.push_back({*r++, WheelTrack::right});
        }
    }
    return lane;
}

/// Returns whether an event is a groove or ridge across the lane.
bool is_line(const LaneEvent& event) {
    return event.event.shape != EventShape::step && event.event.length_m <= line_length_m &&
           event.track != WheelTrack::left && event.track != WheelTrack::right;
}

bool are_rails(const LaneEvent& first, const LaneEvent& second) {
    const double apart_m = second.event.at_m - first.event.at_m;
    const auto [smaller, larger] =
        std::minmax({magnitude_mm(first.event), magnitude_mm(second.event)});
    return is_line(first) && is_line(second) && first.event.shape == second.event.shape &&
           apart_m >= min_rails_m && apart_m <= max_rails_m && smaller >= alike_rails * larger;
}

EventKind kind_of(const LaneEvent& event) {
    if (event.event.shape == EventShape::step ||
        (is_line(event) && event.track == WheelTrack::both)) {
        return EventKind::joint;
    }
    return event.event.shape == EventShape::dip ? EventKind::pothole : EventKind::bump;
}

RoadEvent road_event(const LaneEvent& of, EventKind kind, double start_travel_m) {
    return {.kind = kind,
            .track = of.track,
            .travel_m = start_travel_m + of.event.at_m,
            .length_m = of.event.length_m,
            .size_mm = magnitude_mm(of.event),
            .sd_mm = of.event.sd_mm,
            .score = of.event.score};
}

/// Returns two lines as one pair of rails.
RoadEvent rails_of(const LaneEvent& first, const LaneEvent& second, double start_travel_m) {
    const auto& larger = magnitude_mm(first.event) < magnitude_mm(second.event) ? second : first;
    auto event = road_event(larger, EventKind::rail, start_travel_m);
    event.travel_m = start_travel_m + (first.event.at_m + second.event.at_m) / 2;
    event.length_m = second.event.at_m - first.event.at_m;
    return event;
}

std::vector<LaneEvent> lane_events(const EstimatedProfile& profile, const EventConfig& config) {
    const auto in_track = [&](const auto& track_m, const auto& error_m, const auto& thresholds) {
        return events_in_track(track_m, error_m, profile.step_m, thresholds);
    };
    if (!profile.left_m.empty()) {
        return joined(in_track(profile.left_m, profile.left_error_m, config),
                      in_track(profile.right_m, profile.right_error_m, config));
    }
    auto of_mean = config;
    of_mean.min_hole_mm = config.min_mean_hole_mm;
    std::vector<LaneEvent> lane;
    for (const auto& event : in_track(profile.centre_m, profile.centre_error_m, of_mean)) {
        lane.push_back({event, WheelTrack::unknown});
    }
    return lane;
}

} // namespace

std::vector<RoadEvent> detect_events(const EstimatedProfile& profile, const EventConfig& config) {
    const auto lane = lane_events(profile, config);
    std::vector<RoadEvent> events;
    for (std::size_t i = 0; i < lane.size(); ++i) {
        if (i + 1 < lane.size() && are_rails(lane[i], lane[i + 1])) {
            events.push_back(rails_of(lane[i], lane[i + 1], profile.start_travel_m));
            ++i;
        } else {
            events.push_back(road_event(lane[i], kind_of(lane[i]), profile.start_travel_m));
        }
    }
    return events;
}

} // namespace macadam
