#include "estimator/live/live_trace.hpp"

#include "estimator/clocks/gnss_latency.hpp"
#include "estimator/roughness/roughness_mean.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace macadam {
namespace {

constexpr double vibration_s = 75; // a window, and the tuning of a car
constexpr double motion_s = 600;   // estimation of wheel speed scale and latency
constexpr double look_every_s = 0.1;
constexpr double look_back_every_s = 15;
constexpr double settled_s = 3;
constexpr double longest_piece_m = 20;    // longer rows are smoothed in pieces
constexpr double longest_silence_s = 10;  // between fixes that are interpolated
constexpr double longest_reckoning_s = 5; // of linear extrapolation after the last fix
constexpr double infinity = std::numeric_limits<double>::infinity();

LiveRulerConfig ruler_config(const LiveConfig& config) {
    return {.odometer = config.odometer, .settled_s = settled_s, .keep_s = vibration_s};
}

bool has_place(const GnssFix& fix) {
    return std::isfinite(fix.at.lat_deg) && std::isfinite(fix.at.lon_deg);
}

/// Returns the antenna position, interpolated between two fixes or extrapolated from the last two.
std::optional<GeoPoint> place_at(const TripLog& trip, double t_s) {
    const GnssFix* before = nullptr;
    const GnssFix* after = nullptr;
    for (auto fix = trip.fixes.rbegin(); fix != trip.fixes.rend(); ++fix) {
        if (!has_place(*fix)) {
            continue;
        }
        if (before != nullptr) {
            after = before;
        }
        before = &*fix;
        if (after != nullptr && before->t_s - trip.meta.gnss_latency_s <= t_s) {
            break;
        }
    }
    if (after == nullptr) {
        return std::nullopt;
    }
    const double from_s = before->t_s - trip.meta.gnss_latency_s;
    const double to_s = after->t_s - trip.meta.gnss_latency_s;
    if (t_s < from_s || to_s - from_s > longest_silence_s || t_s > to_s + longest_reckoning_s) {
        return std::nullopt;
    }
    return between(before->at, after->at, (t_s - from_s) / (to_s - from_s));
}

} // namespace

LiveTrace::LiveTrace(const TripMeta& meta, Vehicle vehicle, const LiveConfig& config)
    : config_{config}, recent_{meta, vibration_s, motion_s}, mounting_{meta},
      roughness_{std::move(vehicle), config.stretch, config.estimator, config.window},
      looked_s_{-infinity}, looked_back_s_{-infinity}, scale_is_free_{!meta.speed_scale} {}

std::vector<LiveRow> LiveTrace::add(const TripLog& samples) {
    recent_.add(samples);
    const double now = recent_.now_s();
    if (!(now - looked_s_ >= look_every_s)) {
        return {};
    }
    looked_s_ = now;
    look(false);
    const auto end_s = next_end_s();
    if (!end_s || now - *end_s < config_.max_later_s) {
        return {};
    }
    const double final_s = now - config_.min_later_s;
    roughness_.go_on(recent_.trip(), *ruler_.odometer, mounting_.mounting(), now, final_s);
    return rows_until(ruler_.odometer->travel_m(final_s) + roughness_.rear_m());
}

std::vector<LiveRow> LiveTrace::finish() {
    if (recent_.now_s() == -infinity) {
        return {};
    }
    look(true);
    if (!ruler_.odometer) {
        return {};
    }
    roughness_.go_on(
        recent_.trip(), *ruler_.odometer, mounting_.mounting(), infinity, recent_.now_s());
    return rows_until(travelled_m());
}

double LiveTrace::travelled_m() const {
    return ruler_.odometer ? ruler_.odometer->knots().travel_m.back() : 0;
}

/// Updates the wheel speed scale and the receiver's latency from the last minutes, from time to
/// time.
void LiveTrace::look_back() {
    looked_back_s_ = recent_.now_s();
    if (!recent_.meta().gnss_latency_stated) {
        if (const auto latency_s = estimate_gnss_latency_s(recent_.trip())) {
            found_latency_s_ = latency_s;
            recent_.meta().gnss_latency_s = *latency_s;
        }
    }
    if (scale_is_free_) {
        TripLog motion;
        motion.meta = recent_.trip().meta;
        motion.meta.speed_scale.reset();
        motion.speed = recent_.trip().speed;
        motion.fixes = recent_.trip().fixes;
        const auto measured = measured_on({}, motion, now_s(), ruler_config(config_));
        if (measured.odometer) {
            recent_.meta().speed_scale = measured.odometer->scale();
        }
    }
}

/// Updates everything but the road, up to now.
void LiveTrace::look(bool over) {
    const double now = recent_.now_s();
    if (now - looked_back_s_ >= look_back_every_s) {
        look_back();
    }
    ruler_ = measured_on(
        std::move(ruler_), recent_.motion_beside_vibration(), now, ruler_config(config_), over);
    if (ruler_.odometer) {
        mounting_.add(recent_.trip(), *ruler_.odometer, now);
        note_middle();
    }
}

void LiveTrace::note_middle() {
    const double middle_m = (static_cast<double>(reported_) + 0.5) * config_.length_m;
    const auto& odometer = *ruler_.odometer;
    if (!middle_ && odometer.travel_m(now_s() - settled_s) >= middle_m) {
        middle_ = middle_at(middle_m);
    }
}

LiveTrace::Middle LiveTrace::middle_at(double travel_m) const {
    const double t_s = ruler_.odometer->t_s(travel_m);
    return {t_s, ruler_.odometer->speed_mps(t_s), place_at(recent_.trip(), t_s)};
}

/// Returns the time at which the rear axle reached the end of the next row; `std::nullopt` if it
/// has not.
std::optional<double> LiveTrace::next_end_s() const {
    if (!ruler_.odometer) {
        return std::nullopt;
    }
    const double piece_m = std::min(config_.length_m, longest_piece_m);
    const double reported_m = static_cast<double>(reported_) * config_.length_m;
    const double known_m = std::max(reported_m, roughness_.known_until_m());
    const double end_m =
        std::min((std::floor(known_m / piece_m) + 1) * piece_m, reported_m + config_.length_m) -
        roughness_.rear_m();
    return travelled_m() >= end_m ? std::optional{ruler_.odometer->t_s(end_m)} : std::nullopt;
}

std::vector<LiveRow> LiveTrace::rows_until(double travel_m) {
    std::vector<LiveRow> rows;
    while (static_cast<double>(reported_ + 1) * config_.length_m <= travel_m) {
        const double from_m = static_cast<double>(reported_) * config_.length_m;
        const double seen_m = ruler_.odometer->past_gap_m(
            from_m, static_cast<double>(reported_ + 1) * config_.length_m);
        if (seen_m > from_m) {
            reported_ =
                std::max(reported_ + 1, static_cast<std::size_t>(seen_m / config_.length_m));
        } else {
            rows.push_back(row_from(from_m));
            ++reported_;
        }
        middle_.reset();
    }
    roughness_.forget_before(static_cast<double>(reported_) * config_.length_m);
    return rows;
}

LiveRow LiveTrace::row_from(double from_m) const {
    const double to_m = from_m + config_.length_m;
    const auto middle = middle_ ? *middle_ : middle_at((from_m + to_m) / 2);
    const auto mean = mean_over(roughness_.trace(), from_m, to_m, roughness_.vehicle());
    return {.from_m = from_m,
            .to_m = to_m,
            .t_s = middle.t_s,
            .at = middle.at,
            .speed_mps = mean.hri_mm_per_m ? mean.speed_mps : middle.speed_mps,
            .mean = mean,
            .left_s = ruler_.odometer->t_s(to_m - roughness_.rear_m())};
}

} // namespace macadam
