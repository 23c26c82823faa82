#include "estimator/motion/make_odometer.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/statistics.hpp"
#include "estimator/motion/gnss_track.hpp"
#include "estimator/motion/outlier_gate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

namespace macadam {
namespace {

constexpr double speed_noise_mps = 0.5; // steps of a coarse sensor, at any time interval
constexpr double thin_s = 0.04;         // no car changes its speed unevenly in this time
constexpr double border_s = 1e-3;       // from the last reading to the beginning of a gap
constexpr double blind_s = 60;          // longer silences at a constant speed are not accepted

constexpr double compare_above_mps = 5; // above this GNSS speed is good to about 1 %
constexpr std::size_t min_comparisons = 20;
constexpr double sd_of_scales = 0.03; // tyre wear and pressure, and the maker's margin
constexpr double sd_common = 0.001;   // of GNSS speed itself
constexpr double max_scale = 1.1;
constexpr double sd_median_over_mean = 1.2533;

/// Speed at its own time, latency removed; negative when reversing.
struct Reading {
    double t_s;
    double speed_mps;
};

/// Averages the readings within each `thin_s`, so that a fast bus needs no more memory than a slow
/// one: the distance is preserved. The first and the last reading are unchanged.
class Thinner {
public:
    void take(const Reading& reading) {
        if (count_ > 0 && (readings_.empty() || reading.t_s - begin_s_ >= thin_s)) {
            close();
        }
        begin_s_ = count_ == 0 ? reading.t_s : begin_s_;
        sum_ = {sum_.t_s + reading.t_s - begin_s_, sum_.speed_mps + reading.speed_mps};
        last_ = reading;
        ++count_;
    }

    std::vector<Reading> finish() {
        if (count_ > 1) {
            sum_ = {sum_.t_s - (last_.t_s - begin_s_), sum_.speed_mps - last_.speed_mps};
            --count_;
            close();
            readings_.push_back(last_);
        } else if (count_ == 1) {
            close();
        }
        return std::move(readings_);
    }

private:
    void close() {
        const auto n = static_cast<double>(count_);
        readings_.push_back({begin_s_ + sum_.t_s / n, sum_.speed_mps / n});
        sum_ = {};
        count_ = 0;
    }

    std::vector<Reading> readings_;
    Reading sum_{}; ///< of times since begin_s_, and of speeds
    Reading last_{};
    double begin_s_ = 0;
    int count_ = 0;
};

/// Returns the readings that are consistent with their neighbours; marks the others, if they were
/// readable.
template <typename At>
std::vector<Reading> plausible_readings(std::size_t count,
                                        At at,
                                        const OdometerConfig& config,
                                        std::vector<std::uint8_t>& use) {
    const auto follows = [&](std::size_t i, std::size_t j) {
        const Reading a = at(i);
        const Reading b = at(j);
        const double max_mps = config.max_accel_mps2 * (b.t_s - a.t_s) + speed_noise_mps;
        return std::abs(b.speed_mps) <= config.max_speed_mps &&
               std::abs(b.speed_mps - a.speed_mps) <= max_mps;
    };
    const auto links = gate_outliers(count, follows, [](std::size_t, std::size_t) { return true; });
    Thinner thinner;
    for (std::size_t i = 0; i < count; ++i) {
        use[i] = links[i] == GateDecision::dropped ? code(RowReason::implausible) : 0;
        if (links[i] != GateDecision::dropped) {
            thinner.take(at(i));
        }
    }
    return thinner.finish();
}

struct WheelReadings {
    std::vector<Reading> readings;
    SampleUse use;
};

WheelReadings wheel_readings(const TripLog& trip, const OdometerConfig& config) {
    const double scale = trip.meta.speed_scale.value_or(1);
    const auto at = [&](std::size_t i) {
        return Reading{trip.speed.t_s[i] - trip.meta.speed_latency_s,
                       scale * static_cast<double>(trip.speed.speed_mps[i])};
    };
    WheelReadings wheels{.readings = {}, .use = SampleUse(trip.speed.t_s.size())};
    wheels.readings = plausible_readings(wheels.use.size(), at, config, wheels.use);
    return wheels;
}

struct GnssReadings {
    std::vector<Reading> readings;
    std::vector<std::size_t> fixes; ///< fixes with a speed
    SampleUse use;                  ///< one entry per such fix
};

GnssReadings gnss_readings(const TripLog& trip, const OdometerConfig& config) {
    GnssReadings gnss;
    for (std::size_t i = 0; i < trip.fixes.size(); ++i) {
        if (trip.fixes[i].speed_mps >= 0) {
            gnss.fixes.push_back(i);
        }
    }
    gnss.use.resize(gnss.fixes.size());
    const auto at = [&](std::size_t i) {
        const auto& fix = trip.fixes[gnss.fixes[i]];
        return Reading{fix.t_s - trip.meta.gnss_latency_s, static_cast<double>(fix.speed_mps)};
    };
    gnss.readings = plausible_readings(gnss.fixes.size(), at, config, gnss.use);
    return gnss;
}

/// Returns the factor that makes wheel speed agree with GNSS: the median of their ratio at speed,
/// drawn towards 1 according to its uncertainty.
double scale_between(const Odometer& wheels, const std::vector<Reading>& gnss) {
    std::vector<double> ratios;
    for (const auto& reading : gnss) {
        const double wheel_mps = wheels.speed_mps(reading.t_s);
        if (reading.speed_mps >= compare_above_mps && wheel_mps >= compare_above_mps / 2 &&
            !wheels.reversing(reading.t_s)) {
            ratios.push_back(reading.speed_mps / wheel_mps);
        }
    }
    if (ratios.size() < min_comparisons) {
        return 1;
    }
    const double middle = median(ratios);
    std::vector<double> apart(ratios.size());
    std::ranges::transform(ratios, apart.begin(), [&](double r) { return std::abs(r - middle); });
    // A receiver's errors within one second are correlated.
    const double independent =
        std::min(static_cast<double>(ratios.size()), gnss.back().t_s - gnss.front().t_s + 1);
    const double sd =
        std::hypot(sd_median_over_mean * normal_sd_per_mad * median(apart) / std::sqrt(independent),
                   sd_common);
    const double trust = sd_of_scales * sd_of_scales / (sd_of_scales * sd_of_scales + sd * sd);
    return std::clamp(1 + trust * (middle - 1), 2 - max_scale, max_scale);
}

/// Fills the silences of `main` with readings of `other`.
std::vector<Reading>
filled(const std::vector<Reading>& main, const std::vector<Reading>& other, double max_gap_s) {
    std::vector<Reading> all;
    all.reserve(main.size());
    auto next = other.begin();
    double last_s = -std::numeric_limits<double>::infinity();
    const auto fill_until = [&](double until_s) {
        for (; next != other.end() && next->t_s < until_s; ++next) {
            if (next->t_s > last_s && until_s - last_s > max_gap_s) {
                all.push_back(*next);
            }
        }
    };
    for (const auto& reading : main) {
        fill_until(reading.t_s);
        all.push_back(reading);
        last_s = reading.t_s;
    }
    fill_until(std::numeric_limits<double>::infinity());
    return all;
}

/// Removes readings whose time is unknown because the log's clock ran on while the car stood (or
/// vice versa).
std::vector<Reading> without_pauses(std::vector<Reading> readings, const GnssTrack& track) {
    const auto& places = track.places;
    std::erase_if(readings, [&](const Reading& reading) {
        const auto next = std::ranges::upper_bound(places, reading.t_s, {}, &GnssPosition::t_s);
        return next != places.begin() && next != places.end() && next->restarts &&
               std::prev(next)->t_s < reading.t_s;
    });
    return readings;
}

/// Builds knots reading by reading.
class KnotMaker {
public:
    explicit KnotMaker(const Reading& first) : last_{first} { store(first.t_s, speed_of(first)); }

    void go_on(const Reading& reading) {
        travel_m_ += (speed_of(last_) + speed_of(reading)) / 2 * (reading.t_s - last_.t_s);
        last_ = reading;
        store(last_.t_s, speed_of(last_));
    }

    /// Bridges a gap in the speeds: by the positions within it if there are any, else by the
    /// speeds.
    void jump(const Reading& reading, const std::optional<Odometer>& places) {
        const double begin_s = last_.t_s;
        const double begin_m = travel_m_;
        constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
        store(begin_s + std::min(border_s, (reading.t_s - begin_s) / 2), unknown);
        if (places && places->start_s() < reading.t_s && places->end_s() > begin_s) {
            const double from_m = places->travel_m(begin_s) - begin_m;
            const auto& steps = places->knots();
            auto step = std::ranges::upper_bound(steps.t_s, knots_.t_s.back()) - steps.t_s.begin();
            for (; step < std::ssize(steps.t_s) && steps.t_s[step] < reading.t_s; ++step) {
                travel_to(steps.travel_m[step] - from_m);
                store(steps.t_s[step], unknown);
            }
            travel_to(places->travel_m(reading.t_s) - from_m);
        } else {
            travel_m_ += (speed_of(last_) + speed_of(reading)) / 2 *
                         std::min(reading.t_s - begin_s, blind_s);
        }
        last_ = reading;
        store(last_.t_s, speed_of(last_));
    }

    Odometer::Knots finish() { return std::move(knots_); }

private:
    static double speed_of(const Reading& reading) { return std::abs(reading.speed_mps); }

    /// Never goes back, not even by rounding.
    void travel_to(double travel_m) { travel_m_ = std::max(travel_m_, travel_m); }

    void store(double t_s, double speed_mps) {
        knots_.t_s.push_back(t_s);
        knots_.travel_m.push_back(travel_m_);
        knots_.speed_mps.push_back(static_cast<float>(speed_mps));
        knots_.reversing.push_back(last_.speed_mps < 0 ? 1 : 0);
    }

    Reading last_;
    double travel_m_ = 0;
    Odometer::Knots knots_;
};

Odometer::Knots knots_of(const std::vector<Reading>& readings,
                         const std::optional<Odometer>& places,
                         const std::vector<double>& pause_ends_s,
                         double max_gap_s) {
    const bool places_first = places && places->start_s() + max_gap_s < readings.front().t_s;
    KnotMaker maker{places_first ? Reading{places->start_s(), 0} : readings.front()};
    if (places_first) {
        maker.jump(readings.front(), places);
    }
    for (std::size_t i = 1; i < readings.size(); ++i) {
        const double from_s = readings[i - 1].t_s;
        const double to_s = readings[i].t_s;
        const auto pause = std::ranges::upper_bound(pause_ends_s, from_s);
        const bool paused = pause != pause_ends_s.end() && *pause <= to_s;
        if (paused || to_s - from_s > max_gap_s) {
            maker.jump(readings[i], places);
        } else {
            maker.go_on(readings[i]);
        }
    }
    if (places && places->end_s() > readings.back().t_s + max_gap_s) {
        maker.jump({places->end_s(), 0}, places);
    }
    return maker.finish();
}

/// Returns an upper bound of the travel: where the speed is not known, that of the fastest car.
Odometer farthest_of(const std::vector<Reading>& readings, const OdometerConfig& config) {
    Odometer::Knots knots;
    double travel_m = 0;
    for (std::size_t i = 0; i < readings.size(); ++i) {
        const double t_s = readings[i].t_s;
        const double speed_mps = std::abs(readings[i].speed_mps);
        if (i > 0) {
            const double silence_s = t_s - readings[i - 1].t_s;
            const double mean_mps = (speed_mps + std::abs(readings[i - 1].speed_mps)) / 2;
            travel_m +=
                silence_s * (silence_s > config.max_gap_s ? config.max_speed_mps : mean_mps);
        }
        knots.t_s.push_back(t_s);
        knots.travel_m.push_back(travel_m);
        knots.speed_mps.push_back(static_cast<float>(speed_mps));
        knots.reversing.push_back(readings[i].speed_mps < 0 ? 1 : 0);
    }
    return Odometer{std::move(knots)};
}

std::vector<double> pause_ends(const GnssTrack& track) {
    std::vector<double> ends_s;
    for (const auto& place : track.places) {
        if (place.restarts) {
            ends_s.push_back(place.t_s);
        }
    }
    return ends_s;
}

/// Returns the travel of the intervals that end at, or span, the end of a pause.
std::vector<Odometer::Pause> pauses_in(const Odometer::Knots& knots,
                                       const std::vector<double>& ends_s) {
    std::vector<Odometer::Pause> pauses;
    for (const double end_s : ends_s) {
        const auto next = std::ranges::lower_bound(knots.t_s, end_s);
        if (next == knots.t_s.begin() || next == knots.t_s.end()) {
            continue;
        }
        const auto i = static_cast<std::size_t>(next - knots.t_s.begin());
        const bool is_new = pauses.empty() || pauses.back().to_m <= knots.travel_m[i - 1];
        if (std::isnan(knots.speed_mps[i - 1]) && is_new) {
            pauses.push_back({knots.travel_m[i - 1], knots.travel_m[i]});
        }
    }
    return pauses;
}

/// Returns the use of the fixes; a fix was used if its position or its speed was.
SampleUse use_of_fixes(SampleUse positions, const GnssReadings& gnss, bool speeds_used) {
    for (std::size_t i = 0; i < gnss.fixes.size(); ++i) {
        auto& fix = positions[gnss.fixes[i]];
        if (speeds_used && gnss.use[i] == 0 && fix != code(RowReason::repeated_fix)) {
            fix = 0;
        }
    }
    return positions;
}

} // namespace

MeasuredOdometer make_odometer(const TripLog& trip, const OdometerConfig& config) {
    const auto gnss = gnss_readings(trip, config);
    auto [wheels, speed_use] = wheel_readings(trip, config);
    const bool by_wheels = wheels.size() >= 2;
    double scale = trip.meta.speed_scale.value_or(1);
    if (by_wheels && !trip.meta.speed_scale) {
        scale = scale_between(farthest_of(wheels, config), gnss.readings);
        std::ranges::for_each(wheels, [&](Reading& r) { r.speed_mps *= scale; });
    }
    auto readings =
        filled(by_wheels ? wheels : std::vector<Reading>{}, gnss.readings, config.max_gap_s);
    std::vector<Reading>{}.swap(wheels);

    std::optional<Odometer> farthest;
    if (readings.size() >= 2) {
        farthest.emplace(farthest_of(readings, config));
    }
    const auto track = track_of(trip, config, farthest ? &*farthest : nullptr);
    const auto places = odometer_of(track, config);
    farthest.reset();
    auto fix_use = use_of_fixes(track.use, gnss, readings.size() >= 2);

    readings = without_pauses(std::move(readings), track);
    if (readings.size() >= 2) {
        const auto ends_s = pause_ends(track);
        auto knots = knots_of(readings, places, ends_s, config.max_gap_s);
        auto pauses = pauses_in(knots, ends_s);
        return {Odometer{std::move(knots), by_wheels ? scale : 1, std::move(pauses)},
                std::move(speed_use),
                std::move(fix_use)};
    }
    if (!places) {
        throw InputError{fmt::format(
            "trip has {} speeds and {} fixes that can be used, expected speeds or at least 2 fixes",
            readings.size(),
            track.places.size())};
    }
    return {Odometer{places->knots(), 1, pauses_in(places->knots(), pause_ends(track))},
            std::move(speed_use),
            std::move(fix_use)};
}

} // namespace macadam
