#include "estimator/motion/gnss_track.hpp"

#include "estimator/common/angle.hpp"
#include "estimator/motion/outlier_gate.hpp"

#include <cmath>
#include <limits>
#include <vector>

namespace macadam {
namespace {

constexpr double worst_accuracy_m = 50;  // a receiver that states more has no position yet
constexpr double typical_accuracy_m = 5; // open sky, if the receiver states no accuracy
constexpr double position_noise_m = 20;  // beyond the stated accuracy, rarely more
constexpr double odometer_slack = 1.3;   // wheel slip and missed speeds
constexpr double moving_mps = 0.5;       // above this speed the position must change
constexpr double stale_s = 0.5;          // car receivers do not repeat a position for that long
constexpr double outvoting_s = 2.5;      // beside a wall, receivers stray for a second and return
constexpr double standing_mps = 1;       // mean speed below which the car stood first and then left

// Closer positions count as one: over thirty metres of road, positions with an error of 4 m give
// the length to 2 %, and a receiver at rest does not drift that far.
constexpr double min_move_m = 15;

bool repeats(const GnssFix& fix, const GnssFix& before) {
    const bool unmoved = fix.at == before.at;
    const bool must_move = !(fix.speed_mps <= static_cast<float>(moving_mps));
    return unmoved && (must_move || fix.t_s - before.t_s < stale_s);
}

/// Returns the indices of candidate fixes; the reason for rejecting the others goes into
/// `track.use`.
std::vector<std::size_t> candidates(const TripLog& trip, GnssTrack& track) {
    std::vector<std::size_t> kept;
    const GnssFix* before = nullptr;
    for (std::size_t i = 0; i < trip.fixes.size(); ++i) {
        const auto& fix = trip.fixes[i];
        if (before != nullptr && repeats(fix, *before)) {
            track.use[i] = code(RowReason::repeated_fix);
            continue;
        }
        before = &fix;
        if (static_cast<double>(fix.accuracy_m) > worst_accuracy_m) {
            track.use[i] = code(RowReason::inaccurate);
            continue;
        }
        kept.push_back(i);
    }
    return kept;
}

GnssPosition place_of(const GnssFix& fix, double latency_s) {
    const auto accuracy_m = static_cast<double>(fix.accuracy_m);
    return {.t_s = fix.t_s - latency_s,
            .at = fix.at,
            .accuracy_m = std::isnan(accuracy_m) ? typical_accuracy_m : accuracy_m,
            .restarts = false};
}

double farthest_m(const GnssPosition& a,
                  const GnssPosition& b,
                  const OdometerConfig& config,
                  const Odometer* odometer) {
    const double slack_m = position_noise_m + a.accuracy_m + b.accuracy_m;
    if (odometer != nullptr && a.t_s >= odometer->start_s() && b.t_s <= odometer->end_s()) {
        return odometer_slack * (odometer->travel_m(b.t_s) - odometer->travel_m(a.t_s)) + slack_m;
    }
    return config.max_speed_mps * (b.t_s - a.t_s) + slack_m;
}

/// Path between two positions that the car certainly travelled.
struct TrackSpan {
    double begin_s;
    double end_s;
    double length_m;
    bool known; ///< measured throughout
};

class SpanMaker {
public:
    SpanMaker(const GnssPosition& first, double max_gap_s)
        : max_gap_s_{max_gap_s}, anchor_{first}, last_{first} {}

    void go_to(const GnssPosition& place) {
        seen_ = seen_ && !place.restarts && place.t_s - last_.t_s <= max_gap_s_;
        const double moved_m = distance_m(anchor_.at, place.at);
        if (place.restarts || moved_m > min_move_m + (anchor_.accuracy_m + place.accuracy_m) / 2) {
            leave_for(place, moved_m);
        }
        last_ = place;
    }

    /// The car is taken as standing if the last position is too near to the anchor.
    std::vector<TrackSpan> finish() {
        if (last_.t_s > anchor_.t_s) {
            const bool still = !spans_.empty() || standing_since_anchor();
            spans_.push_back(
                {anchor_.t_s, last_.t_s, still ? 0 : distance_m(anchor_.at, last_.at), seen_});
        }
        return std::move(spans_);
    }

private:
    bool standing_since_anchor() const {
        return distance_m(anchor_.at, last_.at) < standing_mps * (last_.t_s - anchor_.t_s);
    }

    void leave_for(const GnssPosition& place, double moved_m) {
        const bool stood = moved_m < standing_mps * (place.t_s - anchor_.t_s);
        if (stood && last_.t_s > anchor_.t_s) {
            spans_.push_back({anchor_.t_s, last_.t_s, 0, seen_});
            spans_.push_back({last_.t_s, place.t_s, moved_m, seen_});
        } else {
            spans_.push_back({anchor_.t_s, place.t_s, moved_m, seen_});
        }
        anchor_ = place;
        seen_ = true;
    }

    double max_gap_s_;
    GnssPosition anchor_;
    GnssPosition last_;
    bool seen_ = true;
    std::vector<TrackSpan> spans_;
};

/// Returns the speed at a border of two spans: their mean, or that of the known one.
float speed_between(const TrackSpan& before, const TrackSpan& after) {
    const double first_mps = before.length_m / (before.end_s - before.begin_s);
    const double second_mps = after.length_m / (after.end_s - after.begin_s);
    return static_cast<float>(before.known ? (first_mps + second_mps) / 2 : second_mps);
}

Odometer::Knots knots_of(const std::vector<TrackSpan>& spans) {
    constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
    Odometer::Knots knots;
    double travel_m = 0;
    for (std::size_t i = 0; i < spans.size(); ++i) {
        const auto& span = spans[i];
        knots.t_s.push_back(span.begin_s);
        knots.travel_m.push_back(travel_m);
        knots.speed_mps.push_back(span.known ? speed_between(spans[i == 0 ? 0 : i - 1], span)
                                             : unknown);
        travel_m += span.length_m;
    }
    const auto& last = spans.back();
    knots.t_s.push_back(last.end_s);
    knots.travel_m.push_back(travel_m);
    knots.speed_mps.push_back(last.known ? speed_between(last, last) : unknown);
    knots.reversing.assign(knots.t_s.size(), 0);
    return knots;
}

} // namespace

GnssTrack track_of(const TripLog& trip, const OdometerConfig& config, const Odometer* farthest) {
    GnssTrack track{.places = {}, .use = std::vector<std::uint8_t>(trip.fixes.size(), 0)};
    const auto kept = candidates(trip, track);
    std::vector<GnssPosition> places;
    places.reserve(kept.size());
    for (const auto i : kept) {
        places.push_back(place_of(trip.fixes[i], trip.meta.gnss_latency_s));
    }
    const auto follows = [&](std::size_t i, std::size_t j) {
        return i == j || distance_m(places[i].at, places[j].at) <=
                             farthest_m(places[i], places[j], config, farthest);
    };
    const auto long_enough = [&](std::size_t i, std::size_t j) {
        return places[j].t_s - places[i].t_s >= outvoting_s;
    };
    const auto links = gate_outliers(places.size(), follows, long_enough);
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (links[i] == GateDecision::dropped) {
            track.use[kept[i]] = code(RowReason::implausible);
            continue;
        }
        places[i].restarts = links[i] == GateDecision::restarts;
        track.places.push_back(places[i]);
    }
    return track;
}

std::optional<Odometer> odometer_of(const GnssTrack& track, const OdometerConfig& config) {
    if (track.places.size() < 2) {
        return std::nullopt;
    }
    SpanMaker maker{track.places.front(), config.max_gap_s};
    for (std::size_t i = 1; i < track.places.size(); ++i) {
        maker.go_to(track.places[i]);
    }
    return Odometer{knots_of(maker.finish())};
}

std::vector<GnssChord>
gnss_chords(const TripLog& trip, double min_length_m, double max_duration_s) {
    std::vector<GnssChord> chords;
    const GnssFix* from = nullptr;
    for (const auto& fix : trip.fixes) {
        if (from == nullptr || fix.t_s - from->t_s > max_duration_s) {
            from = &fix;
            continue;
        }
        const double length_m = distance_m(from->at, fix.at);
        if (length_m >= min_length_m) {
            chords.push_back(
                {from->t_s, fix.t_s, length_m, -course_deg(from->at, fix.at) * rad_per_deg});
            from = &fix;
        }
    }
    return chords;
}

} // namespace macadam
