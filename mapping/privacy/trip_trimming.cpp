#include "mapping/privacy/trip_trimming.hpp"

#include "estimator/common/geo.hpp"
#include "estimator/common/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

namespace macadam {
namespace {

constexpr double still_m = 50; // of travel or straight-line distance: a receiver at rest wanders
constexpr double anchor_step_s = 10;  // between candidate positions of a stop
constexpr double same_place_m = 5;    // of travel: fixes that determine the position of an end
constexpr double fix_error_m = 10;    // combined error of an end's and a fix's position
constexpr std::size_t fixes_away = 3; // in a row: ignores a single jump

/// A position of the trip with its travel.
struct TravelPoint {
    double travel_m;
    double t_s;
    GeoPoint at;
};

/// Returns the positions in the order of travel.
std::vector<TravelPoint> places_of(const TripLog& trip, const Odometer& odometer) {
    std::vector<TravelPoint> places;
    for (const auto& fix : trip.fixes) {
        if (std::isfinite(fix.at.lat_deg) && std::isfinite(fix.at.lon_deg)) {
            const double t_s = fix.t_s - trip.meta.gnss_latency_s;
            places.push_back({odometer.travel_m(t_s), t_s, fix.at});
        }
    }
    std::ranges::stable_sort(places, {}, &TravelPoint::travel_m);
    return places;
}

/// Returns the car's position: the consensus of the fixes there, or the nearest one. \param places
/// not empty.
GeoPoint place_at(const std::vector<TravelPoint>& places, double travel_m) {
    const auto first =
        std::ranges::lower_bound(places, travel_m - same_place_m, {}, &TravelPoint::travel_m);
    const auto past =
        std::ranges::upper_bound(places, travel_m + same_place_m, {}, &TravelPoint::travel_m);
    if (first == past) {
        const auto nearest = std::ranges::min_element(places, {}, [&](const TravelPoint& place) {
            return std::abs(place.travel_m - travel_m);
        });
        return nearest->at;
    }
    std::vector<double> lat_deg;
    std::vector<double> lon_deg;
    for (auto place = first; place != past; ++place) {
        lat_deg.push_back(place->at.lat_deg);
        lon_deg.push_back(place->at.lon_deg);
    }
    return {median(std::move(lat_deg)), median(std::move(lon_deg))};
}

// --------------------------------------------------------------------------------------- stops

/// Adds intervals in which travel did not advance or has no knot.
void add_stops_of_ruler(const Odometer::Knots& knots, std::vector<TravelSpan>& stops) {
    std::size_t first = 0;
    for (std::size_t i = 1; i < knots.t_s.size(); ++i) {
        if (knots.t_s[i] - knots.t_s[i - 1] > long_stop_s) {
            stops.push_back({knots.travel_m[i - 1], knots.travel_m[i]});
        }
        while (knots.travel_m[i] - knots.travel_m[first] > still_m) {
            ++first;
        }
        if (knots.t_s[i] - knots.t_s[first] > long_stop_s) {
            stops.push_back({knots.travel_m[first], knots.travel_m[i]});
        }
    }
}

/// Adds intervals in which fixes stayed in one position while travel advanced, or were missing.
void add_stops_of_fixes(std::vector<TravelPoint> places, std::vector<TravelSpan>& stops) {
    std::ranges::stable_sort(places, {}, &TravelPoint::t_s);
    for (std::size_t anchor = 0; anchor < places.size();) {
        std::size_t past = anchor + 1;
        while (past < places.size() && distance_m(places[anchor].at, places[past].at) < still_m) {
            ++past;
        }
        const auto& last = places[past - 1];
        if (last.t_s - places[anchor].t_s > long_stop_s) {
            stops.push_back({places[anchor].travel_m, last.travel_m});
            anchor = past;
            continue;
        }
        const double next_s = places[anchor].t_s + anchor_step_s;
        while (anchor < places.size() && places[anchor].t_s < next_s) {
            ++anchor;
        }
    }
}

std::vector<TravelSpan> joined(std::vector<TravelSpan> spans) {
    std::ranges::sort(spans, {}, &TravelSpan::from_m);
    std::vector<TravelSpan> apart;
    for (const auto& span : spans) {
        if (!apart.empty() && span.from_m <= apart.back().to_m) {
            apart.back().to_m = std::max(apart.back().to_m, span.to_m);
        } else {
            apart.push_back(span);
        }
    }
    return apart;
}

// -------------------------------------------------------------------------------------- lengths

/// Returns the travel from which the fixes stay beyond a straight-line distance from the position
/// at `from_m`, in the order of the range; `std::nullopt`: they never do.
template <typename Iterator>
std::optional<double>
travel_away(Iterator place, Iterator past, const GeoPoint& hidden, double away_m) {
    std::size_t in_a_row = 0;
    double first_m = 0;
    for (; place != past; ++place) {
        in_a_row = distance_m(hidden, place->at) >= away_m ? in_a_row + 1 : 0;
        if (in_a_row == 1) {
            first_m = place->travel_m;
        }
        if (in_a_row == fixes_away) {
            return first_m;
        }
    }
    return std::nullopt;
}

class HiddenPositions {
public:
    HiddenPositions(const TripLog& trip, const Odometer& odometer, const TrimRule& rule)
        : trip_{&trip}, rule_{&rule}, places_{places_of(trip, odometer)}, whole_m_{
                                                                              odometer.whole_m()} {}

    /// Returns the travel from which the trip may be published after a hidden position; beyond the
    /// trip if never.
    double end_after(double hidden_m, std::size_t n) const {
        const double length_m = drawn_m(n);
        const double by_travel_m = hidden_m + length_m;
        if (!rule_->hides_places || places_.empty()) {
            return by_travel_m;
        }
        const auto from = std::ranges::lower_bound(places_, hidden_m, {}, &TravelPoint::travel_m);
        const auto away_m =
            travel_away(from, places_.end(), place_at(places_, hidden_m), length_m + fix_error_m);
        return away_m ? std::max(by_travel_m, *away_m) : whole_m_;
    }

    double begin_before(double hidden_m, std::size_t n) const {
        const double length_m = drawn_m(n);
        const double by_travel_m = hidden_m - length_m;
        if (!rule_->hides_places || places_.empty()) {
            return by_travel_m;
        }
        const auto from = std::ranges::upper_bound(places_, hidden_m, {}, &TravelPoint::travel_m);
        const auto away_m = travel_away(std::make_reverse_iterator(from),
                                        places_.rend(),
                                        place_at(places_, hidden_m),
                                        length_m + fix_error_m);
        return away_m ? std::min(by_travel_m, *away_m) : 0;
    }

private:
    double drawn_m(std::size_t n) const {
        return rule_->min_m +
               (rule_->random_m > 0 ? rule_->random_m * rule_->draw(trip_->sha256, n) : 0);
    }

    const TripLog* trip_;
    const TrimRule* rule_;
    std::vector<TravelPoint> places_;
    double whole_m_;
};

} // namespace

std::vector<TravelSpan> long_stops(const TripLog& trip, const Odometer& odometer) {
    std::vector<TravelSpan> stops;
    add_stops_of_ruler(odometer.knots(), stops);
    add_stops_of_fixes(places_of(trip, odometer), stops);
    for (const auto& pause : odometer.pauses()) { // clock stopped: duration unknown
        stops.push_back({pause.from_m, pause.to_m});
    }
    return joined(std::move(stops));
}

std::vector<TravelSpan>
kept_parts(const TripLog& trip, const Odometer& odometer, const TrimRule& rule) {
    if (!rule.is_active()) {
        return {{0, odometer.whole_m()}};
    }
    std::vector<TravelSpan> hidden{{0, 0}};
    if (rule.hides_places) {
        std::ranges::copy(long_stops(trip, odometer), std::back_inserter(hidden));
    }
    hidden.push_back({odometer.whole_m(), odometer.whole_m()});

    const HiddenPositions places{trip, odometer, rule};
    std::vector<TravelSpan> parts;
    for (std::size_t i = 1; i < hidden.size(); ++i) {
        const TravelSpan part{places.end_after(hidden[i - 1].to_m, 2 * i),
                              places.begin_before(hidden[i].from_m, 2 * i + 1)};
        if (part.from_m < part.to_m) {
            parts.push_back(part);
        }
    }
    return parts;
}

} // namespace macadam
