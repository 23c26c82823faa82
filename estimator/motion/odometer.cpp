#include "estimator/motion/odometer.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace macadam {
namespace {

/// Interval between two knots: the speeds at its ends, the distance that they imply, and its actual
/// length.
struct Piece {
    double begin_mps;
    double end_mps;
    double length_s;
    double length_m;
};

Piece piece_of(const Odometer::Knots& knots, std::size_t i) {
    const auto begin_mps = static_cast<double>(knots.speed_mps[i]);
    const auto end_mps = static_cast<double>(knots.speed_mps[i + 1]);
    return {.begin_mps = begin_mps,
            .end_mps = std::isnan(end_mps) ? begin_mps : end_mps,
            .length_s = knots.t_s[i + 1] - knots.t_s[i],
            .length_m = knots.travel_m[i + 1] - knots.travel_m[i]};
}

double speed_way_m(const Piece& piece) {
    return (piece.begin_mps + piece.end_mps) / 2 * piece.length_s;
}

/// Returns the fraction of the distance covered after the fraction `time` of the duration; linear
/// in time where the speed is not known or zero.
double distance_part(const Piece& piece, double time) {
    const double done_m =
        (piece.begin_mps + (piece.end_mps - piece.begin_mps) / 2 * time) * time * piece.length_s;
    return speed_way_m(piece) > 0 ? done_m / speed_way_m(piece) : time;
}

/// Inverts distance_part: the root of a quadratic, in the form without cancellation.
double time_part(const Piece& piece, double distance) {
    if (!(speed_way_m(piece) > 0)) {
        return distance;
    }
    const double way_m = distance * speed_way_m(piece);
    const double gain_mps2 = (piece.end_mps - piece.begin_mps) / piece.length_s;
    const double speed_mps =
        std::sqrt(std::max(0.0, piece.begin_mps * piece.begin_mps + 2 * gain_mps2 * way_m));
    const double sum_mps = piece.begin_mps + speed_mps;
    return sum_mps > 0 ? std::min(1.0, 2 * way_m / sum_mps / piece.length_s) : 0;
}

} // namespace

Odometer::Odometer(Knots knots, double scale, std::vector<Pause> pauses)
    : knots_{std::move(knots)}, scale_{scale}, pauses_{std::move(pauses)} {
    assert(!knots_.t_s.empty() && knots_.t_s.size() == knots_.travel_m.size() &&
           knots_.t_s.size() == knots_.speed_mps.size() &&
           knots_.t_s.size() == knots_.reversing.size());
    assert(std::ranges::is_sorted(knots_.t_s, std::less_equal{}) &&
           std::ranges::is_sorted(knots_.travel_m));
}

/// Returns the interval that contains a time between the first and the last knot.
std::size_t Odometer::piece_at(double t_s) const {
    const auto after = std::ranges::upper_bound(knots_.t_s, t_s);
    const auto i = static_cast<std::size_t>(after - knots_.t_s.begin());
    return std::min(std::max<std::size_t>(i, 1) - 1, knots_.t_s.size() - 2);
}

double Odometer::travel_m(double t_s) const {
    if (t_s <= start_s()) {
        return knots_.travel_m.front();
    }
    if (t_s >= end_s()) {
        return knots_.travel_m.back();
    }
    const auto i = piece_at(t_s);
    const auto piece = piece_of(knots_, i);
    return knots_.travel_m[i] +
           piece.length_m * distance_part(piece, (t_s - knots_.t_s[i]) / piece.length_s);
}

double Odometer::speed_mps(double t_s) const {
    if (!(t_s >= start_s() && t_s <= end_s())) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    if (knots_.t_s.size() == 1) {
        return static_cast<double>(knots_.speed_mps.front());
    }
    const auto i = piece_at(t_s);
    const auto piece = piece_of(knots_, i);
    const double part = (t_s - knots_.t_s[i]) / piece.length_s;
    return piece.begin_mps + part * (piece.end_mps - piece.begin_mps);
}

bool Odometer::reversing(double t_s) const {
    if (!(t_s >= start_s() && t_s <= end_s()) || knots_.t_s.size() == 1) {
        return false;
    }
    const auto i = piece_at(t_s);
    return knots_.reversing[i] != 0 || knots_.reversing[i + 1] != 0;
}

double Odometer::t_s(double travel_m) const {
    const auto found = std::ranges::lower_bound(knots_.travel_m, travel_m);
    if (found == knots_.travel_m.begin()) {
        return start_s();
    }
    if (found == knots_.travel_m.end()) {
        return end_s();
    }
    const auto i = static_cast<std::size_t>(found - knots_.travel_m.begin()) - 1;
    const auto piece = piece_of(knots_, i);
    const double part = (travel_m - knots_.travel_m[i]) / piece.length_m;
    return knots_.t_s[i] + piece.length_s * time_part(piece, part);
}

double Odometer::past_gap_m(double from_m, double to_m) const {
    const auto after = std::ranges::upper_bound(knots_.travel_m, from_m);
    if (after == knots_.travel_m.begin() || after == knots_.travel_m.end()) {
        return from_m;
    }
    return *after - *(after - 1) > longest_unseen_m && to_m < *after ? *after : from_m;
}

double Odometer::whole_m() const {
    return knots_.travel_m.back() - knots_.travel_m.front();
}

double Odometer::start_s() const {
    return knots_.t_s.front();
}

double Odometer::end_s() const {
    return knots_.t_s.back();
}

} // namespace macadam
