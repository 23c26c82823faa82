#include "storage/trips/rawlog/rawlog_plugin.hpp"

#include "estimator/common/angle.hpp"
#include "estimator/common/error.hpp"

#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace macadam {

namespace {

namespace obs = mrpt::obs;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double knot_mps = 1852.0 / 3600; // ISO 80000-3: one international nautical mile per hour
constexpr double day_s = 86400;

// mrpt::Clock counts 100 ns from 1601-01-01T00:00:00Z.
constexpr std::int64_t ticks_to_1970 = 116'444'736'000'000'000;
constexpr std::int64_t ticks_to_1900 = 94'354'848'000'000'000;
constexpr std::int64_t ticks_to_2500 = 283'697'856'000'000'000;

/// Archive that provides the bytes of exactly one object.
class Source final : public mrpt::serialization::CArchive {
public:
    explicit Source(std::string_view bytes) : rest_{bytes} {}

    bool at_end() const { return rest_.empty(); }
    std::string getArchiveDescription() const override { return "an object"; }

protected:
    std::size_t read(void* to, std::size_t count) override {
        if (count > rest_.size()) {
            throw std::runtime_error{"the object ends too early"};
        }
        std::memcpy(to, rest_.data(), count);
        rest_.remove_prefix(count);
        return count;
    }
    std::size_t write(const void* /*from*/, std::size_t /*count*/) override { return 0; }

private:
    std::string_view rest_;
};

class Sink final : public mrpt::serialization::CArchive {
public:
    const std::string& bytes() const { return bytes_; }
    std::string getArchiveDescription() const override { return "bytes"; }

protected:
    std::size_t read(void* /*to*/, std::size_t /*count*/) override { return 0; }
    std::size_t write(const void* from, std::size_t count) override {
        bytes_.append(static_cast<const char*>(from), count);
        return count;
    }

private:
    std::string bytes_;
};

// ------------------------------------------------------------------------------------ reading

std::optional<std::int64_t> ticks_of(const mrpt::Clock::time_point& time) {
    const std::int64_t ticks = time.time_since_epoch().count();
    return ticks >= ticks_to_1900 && ticks <= ticks_to_2500 ? std::optional{ticks - ticks_to_1970}
                                                            : std::nullopt;
}

RawlogObservation of(const obs::CObservationIMU& imu) {
    const auto value = [&](obs::TIMUDataIndex i) {
        return imu.dataIsPresent[i] ? imu.rawMeasurements[i] : unknown;
    };
    return {.utc_ticks = ticks_of(imu.timestamp),
            .label = imu.sensorLabel,
            .what = RawlogImu{
                .acc_mps2 = {value(obs::IMU_X_ACC), value(obs::IMU_Y_ACC), value(obs::IMU_Z_ACC)},
                .gyro_radps = {value(obs::IMU_WX), value(obs::IMU_WY), value(obs::IMU_WZ)},
                .roll_pitch_yaw_deg = {imu.sensorPose.roll() * deg_per_rad,
                                       imu.sensorPose.pitch() * deg_per_rad,
                                       imu.sensorPose.yaw() * deg_per_rad}}};
}

double day_time_s(const obs::gnss::UTC_time& time) {
    return 3600.0 * time.hour + 60.0 * time.minute + time.sec;
}

RawlogObservation of(const obs::CObservationGPS& gps) {
    RawlogFix fix{.lat_deg = unknown,
                  .lon_deg = unknown,
                  .speed_mps = unknown,
                  .course_deg = unknown,
                  .hdop = unknown,
                  .day_time_s = unknown,
                  .quality = 0};
    if (gps.hasMsgClass<obs::gnss::Message_NMEA_RMC>()) {
        const auto& said = gps.getMsgByClass<obs::gnss::Message_NMEA_RMC>().fields;
        if (said.validity_char == 'A') {
            fix = {.lat_deg = said.latitude_degrees,
                   .lon_deg = said.longitude_degrees,
                   .speed_mps = said.speed_knots * knot_mps,
                   .course_deg = said.direction_degrees,
                   .hdop = unknown,
                   .day_time_s = day_time_s(said.UTCTime),
                   .quality = 1};
        }
    }
    if (gps.hasMsgClass<obs::gnss::Message_NMEA_GGA>()) {
        const auto& said = gps.getMsgByClass<obs::gnss::Message_NMEA_GGA>().fields;
        fix.lat_deg = said.latitude_degrees;
        fix.lon_deg = said.longitude_degrees;
        fix.quality = said.fix_quality;
        fix.day_time_s = day_time_s(said.UTCTime);
        std::uint8_t has_hdop = 0; // a bool from a file may hold any byte
        std::memcpy(&has_hdop, &said.thereis_HDOP, 1);
        fix.hdop = has_hdop != 0 ? said.HDOP : unknown;
    }
    return {.utc_ticks = ticks_of(gps.timestamp), .label = gps.sensorLabel, .what = fix};
}

RawlogObservation of(const obs::CObservationOdometry& odometry) {
    return {.utc_ticks = ticks_of(odometry.timestamp),
            .label = odometry.sensorLabel,
            .what = RawlogOdometry{.x_m = odometry.odometry.x(),
                                   .y_m = odometry.odometry.y(),
                                   .heading_rad = odometry.odometry.phi(),
                                   .speed_mps = odometry.hasVelocities ? odometry.velocityLocal.vx
                                                                       : unknown}};
}

RawlogObservation of(const obs::CObservationComment& comment) {
    return {.utc_ticks = ticks_of(comment.timestamp),
            .label = comment.sensorLabel,
            .what = RawlogComment{comment.text}};
}

RawlogObservation decoded(std::string_view bytes) {
    Source source{bytes};
    const auto object = source.ReadObject();
    if (!source.at_end()) {
        throw std::runtime_error{"the object ends too late"};
    }
    if (const auto* const imu = dynamic_cast<const obs::CObservationIMU*>(object.get())) {
        return of(*imu);
    }
    if (const auto* const gps = dynamic_cast<const obs::CObservationGPS*>(object.get())) {
        return of(*gps);
    }
    if (const auto* const odometry = dynamic_cast<const obs::CObservationOdometry*>(object.get())) {
        return of(*odometry);
    }
    if (const auto* const comment = dynamic_cast<const obs::CObservationComment*>(object.get())) {
        return of(*comment);
    }
    throw std::runtime_error{"the object is of another class"};
}

/// First line of MRPT's messages, which continue with positions in its source.
std::string first_line(std::string_view text) {
    return std::string{text.substr(0, text.find('\n'))};
}

// ------------------------------------------------------------------------------------ writing

obs::CObservationIMU written(const RawlogImu& imu) {
    obs::CObservationIMU object;
    const auto set = [&](obs::TIMUDataIndex i, double value) {
        if (!std::isnan(value)) {
            object.set(i, value);
        }
    };
    set(obs::IMU_X_ACC, imu.acc_mps2[0]);
    set(obs::IMU_Y_ACC, imu.acc_mps2[1]);
    set(obs::IMU_Z_ACC, imu.acc_mps2[2]);
    set(obs::IMU_WX, imu.gyro_radps[0]);
    set(obs::IMU_WY, imu.gyro_radps[1]);
    set(obs::IMU_WZ, imu.gyro_radps[2]);
    return object;
}

obs::gnss::UTC_time utc_time(double since_midnight_s) {
    const double hours = std::floor(since_midnight_s / 3600);
    const double minutes = std::floor(since_midnight_s / 60) - 60 * hours;
    obs::gnss::UTC_time time;
    time.hour = static_cast<std::uint8_t>(hours);
    time.minute = static_cast<std::uint8_t>(minutes);
    time.sec = since_midnight_s - 3600 * hours - 60 * minutes;
    return time;
}

obs::CObservationGPS written(const RawlogFix& fix, const mrpt::Clock::time_point& time) {
    obs::CObservationGPS object;
    object.originalReceivedTimestamp = time;
    const auto utc = utc_time(std::fmod(fix.day_time_s, day_s));
    if (!std::isnan(fix.lat_deg)) {
        obs::gnss::Message_NMEA_GGA gga;
        gga.fields.UTCTime = utc;
        gga.fields.latitude_degrees = fix.lat_deg;
        gga.fields.longitude_degrees = fix.lon_deg;
        gga.fields.fix_quality = static_cast<std::uint8_t>(fix.quality);
        gga.fields.thereis_HDOP = !std::isnan(fix.hdop);
        gga.fields.HDOP = gga.fields.thereis_HDOP ? static_cast<float>(fix.hdop) : 0;
        object.setMsg(gga);
    }
    if (!std::isnan(fix.speed_mps) || !std::isnan(fix.course_deg)) {
        obs::gnss::Message_NMEA_RMC rmc;
        rmc.fields.UTCTime = utc;
        rmc.fields.validity_char = 'A';
        rmc.fields.latitude_degrees = fix.lat_deg;
        rmc.fields.longitude_degrees = fix.lon_deg;
        rmc.fields.speed_knots = fix.speed_mps / knot_mps;
        rmc.fields.direction_degrees = fix.course_deg;
        object.setMsg(rmc);
    }
    return object;
}

obs::CObservationOdometry written(const RawlogOdometry& odometry) {
    obs::CObservationOdometry object;
    object.odometry = {odometry.x_m, odometry.y_m, odometry.heading_rad};
    object.hasVelocities = !std::isnan(odometry.speed_mps);
    object.velocityLocal.vx = object.hasVelocities ? odometry.speed_mps : 0;
    return object;
}

obs::CObservationComment written(const RawlogComment& comment) {
    obs::CObservationComment object;
    object.text = comment.text;
    return object;
}

std::string encoded(const RawlogObservation& observation) {
    const mrpt::Clock::time_point time{
        mrpt::Clock::duration{observation.utc_ticks.value_or(0) + ticks_to_1970}};
    Sink sink;
    const auto put = [&](auto object) {
        object.timestamp = time;
        object.sensorLabel = observation.label;
        sink << object;
    };
    if (const auto* const fix = std::get_if<RawlogFix>(&observation.what)) {
        put(written(*fix, time));
    } else if (const auto* const imu = std::get_if<RawlogImu>(&observation.what)) {
        put(written(*imu));
    } else if (const auto* const odometry = std::get_if<RawlogOdometry>(&observation.what)) {
        put(written(*odometry));
    } else {
        put(written(std::get<RawlogComment>(observation.what)));
    }
    return sink.bytes();
}

} // namespace

} // namespace macadam

extern "C" void macadam_rawlog_decode(std::string_view object,
                                      const std::function<void(macadam::RawlogObservation)>& take) {
    macadam::RawlogObservation observation;
    try {
        observation = macadam::decoded(object);
    } catch (const std::exception& error) {
        throw macadam::InputError{macadam::first_line(error.what())};
    }
    take(std::move(observation));
}

extern "C" void macadam_rawlog_encode(const macadam::RawlogObservation& observation,
                                      const std::function<void(std::string_view)>& put) {
    put(macadam::encoded(observation));
}
