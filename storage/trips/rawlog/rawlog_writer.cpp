#include "storage/trips/rawlog/rawlog_writer.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/plugin_library.hpp"
#include "storage/files/compressed_file.hpp"
#include "storage/trips/log/trip_meta.hpp"
#include "storage/trips/rawlog/rawlog_plugin.hpp"
#include "storage/trips/rawlog/rawlog_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

namespace macadam {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t none = std::numeric_limits<std::int64_t>::max();

std::int64_t ticks(double t_s) {
    return std::llround(t_s * rawlog_ticks_per_s);
}

std::string head_of(const TripMeta& meta) {
    return std::string{rawlog_head_mark} + "\n" + meta_text(meta) + "# " + rawlog_accuracy_key +
           ": 1\n";
}

/// Iterates over the samples of a trip; acceleration and rotation of equal times are combined.
class Observations {
public:
    explicit Observations(const TripLog& trip)
        : trip_{trip}, t0_ticks_{ticks(trip.meta.t0_utc_s.value_or(0))} {}

    /// Next observation; `std::nullopt` at the end.
    std::optional<RawlogObservation> next() {
        const auto imu = std::min(at(trip_.acc.t_s, acc_), at(trip_.gyro.t_s, gyro_));
        const auto speed = at(trip_.speed.t_s, speed_);
        const auto fix = fix_ < trip_.fixes.size() ? ticks(trip_.fixes[fix_].t_s) : none;
        const auto first = std::min({imu, speed, fix});
        if (first == none) {
            return std::nullopt;
        }
        RawlogObservation next{.utc_ticks = t0_ticks_ + first, .label = {}, .what = {}};
        if (imu == first) {
            next.label = "imu";
            next.what = RawlogImu{.acc_mps2 = taken(trip_.acc, acc_, first),
                                  .gyro_radps = taken(trip_.gyro, gyro_, first)};
        } else if (speed == first) {
            next.label = "wheels";
            next.what = odometry();
        } else {
            next.label = "gnss";
            next.what = fix_said(trip_.fixes[fix_++], *next.utc_ticks);
        }
        return next;
    }

private:
    static std::int64_t at(const std::vector<double>& t_s, std::size_t i) {
        return i < t_s.size() ? ticks(t_s[i]) : none;
    }

    static std::array<double, 3>
    taken(const TriaxialSamples& from, std::size_t& i, std::int64_t now) {
        if (at(from.t_s, i) != now) {
            return {unknown, unknown, unknown};
        }
        const auto k = i++;
        return {from.x[k], from.y[k], from.z[k]};
    }

    RawlogOdometry odometry() {
        const auto k = speed_++;
        const double speed_mps = trip_.speed.speed_mps[k];
        if (k > 0) { // mean of both speeds, over the time between them
            driven_m_ += (trip_.speed.t_s[k] - trip_.speed.t_s[k - 1]) *
                         (trip_.speed.speed_mps[k - 1] + speed_mps) / 2;
        }
        return {.x_m = driven_m_, .y_m = 0, .heading_rad = 0, .speed_mps = speed_mps};
    }

    static RawlogFix fix_said(const GnssFix& fix, std::int64_t utc_ticks) {
        constexpr std::int64_t ticks_per_day = 86400 * rawlog_ticks_per_s;
        const auto of_day = (utc_ticks % ticks_per_day + ticks_per_day) % ticks_per_day;
        return {.lat_deg = fix.at.lat_deg,
                .lon_deg = fix.at.lon_deg,
                .speed_mps = fix.speed_mps,
                .course_deg = fix.course_deg,
                .hdop = fix.accuracy_m, // hacc_per_hdop_m: 1
                .day_time_s = static_cast<double>(of_day) / rawlog_ticks_per_s,
                .quality = 1};
    }

    const TripLog& trip_;
    std::int64_t t0_ticks_;
    std::size_t acc_ = 0;
    std::size_t gyro_ = 0;
    std::size_t speed_ = 0;
    std::size_t fix_ = 0;
    double driven_m_ = 0;
};

} // namespace

std::size_t write_rawlog(const TripLog& trip,
                         const std::filesystem::path& file,
                         int level,
                         const std::stop_token& stop) {
    auto* const encode = plugin_function<RawlogEncode>("macadam_rawlog.so", rawlog_encode_name);
    CompressedFile out{file, Compression::gzip, level};
    const std::function<void(std::string_view)> put = [&](std::string_view bytes) {
        out.write(bytes);
    };

    encode({.utc_ticks = ticks(trip.meta.t0_utc_s.value_or(0)),
            .label = {},
            .what = RawlogComment{head_of(trip.meta)}},
           put);
    std::size_t count = 1;
    Observations observations{trip};
    for (auto each = observations.next(); each; each = observations.next(), ++count) {
        encode(*each, put);
        if (stop.stop_requested()) {
            throw InputError{fmt::format("{}: stopped before it was complete", file.string())};
        }
    }
    out.commit();
    return count;
}

} // namespace macadam
