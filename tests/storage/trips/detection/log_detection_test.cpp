// Logs in the styles of several makers, written here from one drive.

#include "storage/trips/detection/detected_mapping.hpp"
#include "storage/trips/mappings/column_mapping_file.hpp"
#include "storage/trips/trip_reader.hpp"
#include "storage/trips/trip_search.hpp"

#include "estimator/common/error.hpp"
#include "support/files/compressed.hpp"
#include "support/files/files.hpp"
#include "support/program/places.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <stop_token>

using namespace macadam;
using namespace macadam::testing;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

namespace {

namespace fs = std::filesystem;

constexpr double g = 9.80665;
constexpr double deg_in_rad = std::numbers::pi / 180;
constexpr std::size_t seconds = 40;
constexpr std::size_t rows_per_s = 20;
constexpr std::size_t row_count = seconds * rows_per_s;

/// Readings at one time of a car on a winding road, from a phone that leans back.
struct Reading {
    double t_s, v_mps, lat_deg, lon_deg, course_deg;
    double ax, ay, az;    ///< m/s2
    double wx, wy, wz;    ///< rad/s
    double vertical_mps2; ///< in the axes of the car
};

std::vector<Reading> drive() {
    std::mt19937 random{11};
    std::normal_distribution<double> noise{0, 1};
    std::vector<Reading> readings;
    double course = 0.7;
    double lat_deg = 47.6875;
    double lon_deg = 17.6346;
    const double lean = 25 * deg_in_rad;
    for (std::size_t i = 0; i < row_count; ++i) {
        const double t_s = static_cast<double>(i) / rows_per_s;
        const double v_mps = 12 + 3 * std::sin(t_s / 6);
        const double turn = 0.1 * std::sin(t_s / 5);
        course += turn / rows_per_s;
        lat_deg += v_mps * std::cos(course) / rows_per_s / 111195;
        lon_deg += v_mps * std::sin(course) / rows_per_s / 111195 / std::cos(lat_deg * deg_in_rad);
        const double up = g + 0.6 * noise(random);
        const double across = -v_mps * turn + 0.2 * noise(random);
        readings.push_back({t_s,
                            v_mps,
                            lat_deg,
                            lon_deg,
                            std::fmod(course / deg_in_rad + 360, 360),
                            0.5 * std::cos(t_s / 6) + 0.2 * noise(random),
                            across * std::cos(lean) + up * std::sin(lean),
                            up * std::cos(lean) - across * std::sin(lean),
                            0.03 * noise(random),
                            0.02 * noise(random),
                            -turn,
                            up});
    }
    return readings;
}

/// Writes a log: a header and a line for each reading; `fix` is the latest one at 1 Hz.
std::string
log_text(const std::string& header,
         const std::function<std::string(const Reading& now, const Reading& fix)>& line) {
    const auto readings = drive();
    auto text = header;
    for (std::size_t i = 0; i < readings.size(); ++i) {
        text += line(readings[i], readings[i / rows_per_s * rows_per_s]) + "\n";
    }
    return text;
}

std::string with_decimal_commas(std::string text) {
    std::ranges::replace(text, '.', ',');
    return text;
}

std::string in_utf16(const std::string& ascii) {
    std::string text = "\xff\xfe";
    for (const char letter : ascii) {
        text += {letter, '\0'};
    }
    return text;
}

/// Latin-1 of text whose only letters beyond ASCII are below U+0100.
std::string in_latin1(const std::string& utf8) {
    std::string text;
    for (std::size_t i = 0; i < utf8.size(); ++i) {
        const auto byte = static_cast<unsigned char>(utf8[i]);
        text += byte < 0x80 ? utf8[i]
                            : static_cast<char>(((byte & 3U) << 6U) |
                                                (static_cast<unsigned char>(utf8[++i]) & 0x3FU));
    }
    return text;
}

const TripNeeds everything{.acc = true, .gyro = true, .speed = true, .fixes = true};

fs::path log_file(const std::string& text, const std::string& name = "drive.csv") {
    return written(test_folder(), name, text);
}

/// Expects that a log is read without a mapping, as the drive that it is of.
void expect_read_as_the_drive(const fs::path& file, double acc_tolerance = 0.05) {
    const auto log = detect_log(file);
    ASSERT_TRUE(log);
    SCOPED_TRACE(mapping_toml(*log, Confidence::likely, "*.csv"));
    ASSERT_THAT(missing_measurements(*log, needs_of_import(), Confidence::sure), IsEmpty());
    const auto trip = read_trip({.file = file, .member = {}}, everything);
    const auto readings = drive();
    ASSERT_THAT(trip.acc.t_s, SizeIs(row_count));
    ASSERT_GE(trip.fixes.size(), seconds - 1);
    for (std::size_t i = 0; i < row_count; i += 7) {
        const auto& truth = readings[i];
        EXPECT_NEAR(trip.acc.t_s[i], truth.t_s, 0.002);
        EXPECT_NEAR(std::hypot(trip.acc.x[i], trip.acc.y[i], trip.acc.z[i]),
                    std::hypot(truth.ax, truth.ay, truth.az),
                    acc_tolerance);
    }
    EXPECT_NEAR(trip.fixes[10].at.lat_deg, readings[10 * rows_per_s].lat_deg, 2e-6);
    EXPECT_NEAR(trip.fixes[10].at.lon_deg, readings[10 * rows_per_s].lon_deg, 2e-6);
    EXPECT_NEAR(trip.fixes[10].speed_mps, readings[10 * rows_per_s].v_mps, 0.1);
    EXPECT_THAT(trip.meta.other, ::testing::Contains(::testing::Key(std::string{detected_key})));
}

const std::string androsensor_header =
    "ACCELEROMETER X (m/s²);ACCELEROMETER Y (m/s²);ACCELEROMETER Z (m/s²);"
    "LINEAR ACCELERATION X (m/s²);LINEAR ACCELERATION Y (m/s²);LINEAR ACCELERATION Z (m/s²);"
    "GYROSCOPE X (rad/s);GYROSCOPE Y (rad/s);GYROSCOPE Z (rad/s);LIGHT (lux);"
    "LOCATION Latitude : ;LOCATION Longitude : ;LOCATION Speed ( Kmh);LOCATION Accuracy ( m);"
    "Satellites in range;Time since start in ms \n";

std::string androsensor_line(const Reading& now, const Reading& fix) {
    return fmt::format("{:.4f};{:.4f};{:.4f};0.1;0.2;0.1;{:.4f};{:.4f};{:.4f};12.0;{:.6f};{:.6f};"
                       "{:.2f};5.0;9 / 12;{:.0f}",
                       now.ax,
                       now.ay,
                       now.az,
                       now.wx,
                       now.wy,
                       now.wz,
                       fix.lat_deg,
                       fix.lon_deg,
                       fix.v_mps * 3.6,
                       now.t_s * 1000);
}

} // namespace

TEST(LogDetection, ReadsAndroSensorByTheUnitsInItsNames) {
    expect_read_as_the_drive(log_file(log_text(androsensor_header, androsensor_line)));
}

TEST(LogDetection, ReadsDecimalCommasAndLatin1) {
    const auto text =
        in_latin1(with_decimal_commas(log_text(androsensor_header, androsensor_line)));
    const auto file = log_file(text);
    expect_read_as_the_drive(file);
    const auto log = detect_log(file);
    EXPECT_EQ(log->names[0], "ACCELEROMETER X (m/s²)");
    const auto toml = mapping_toml(*log, Confidence::likely, "*.csv");
    EXPECT_THAT(toml, HasSubstr("encoding = \"latin-1\"\n"));
    EXPECT_THAT(toml, HasSubstr("acc_z_mps2 = {column = \"ACCELEROMETER Z (m/s²)\", "));
}

TEST(LogDetection, TakesTextWithAStrayByteForUtf8) {
    const auto log =
        detect_log(log_file(log_text("Zeit (s),Höhe (m),Länge\n", [](const Reading& now, auto&) {
            return fmt::format(
                "{:.2f},11{},17.{:.0f}", now.t_s, now.t_s == 3 ? "\xfc" : "0", now.ax);
        })));
    EXPECT_EQ(log->names[1], "Höhe (m)");
}

TEST(LogDetection, FindsUnitsByGravityAndByTheWayDriven) {
    const auto text =
        log_text("time,gFx,gFy,gFz,wx,wy,wz,Latitude,Longitude,Speed\n",
                 [](const Reading& now, const Reading& fix) {
                     return fmt::format("{:.3f},{:.5f},{:.5f},{:.5f},{:.4f},{:.4f},{:.4f},{:.7f},"
                                        "{:.7f},{:.3f}",
                                        now.t_s,
                                        now.ax / g,
                                        now.ay / g,
                                        now.az / g,
                                        now.wx,
                                        now.wy,
                                        now.wz,
                                        fix.lat_deg,
                                        fix.lon_deg,
                                        fix.v_mps / 0.44704);
                 });
    const auto file = log_file(text);
    expect_read_as_the_drive(file);
    EXPECT_EQ(words_of(*detect_log(file)),
              "commas, time in s, acceleration in g, rates in rad/s, GNSS speed in mph");
}

TEST(LogDetection, ReadsUtf16WithDateAndTimeInTwoColumns) {
    const auto text =
        log_text("sep=;\nDatum;Uhrzeit;Breitengrad;Laengengrad;Geschwindigkeit;Beschleunigung X;"
                 "Beschleunigung Y;Beschleunigung Z\n",
                 [](const Reading& now, const Reading& fix) {
                     const auto numbers = with_decimal_commas(
                         fmt::format("{:06.3f};{:.6f};{:.6f};{:.2f};{:.4f};{:.4f};{:.4f}",
                                     now.t_s,
                                     fix.lat_deg,
                                     fix.lon_deg,
                                     fix.v_mps * 3.6,
                                     now.ax,
                                     now.ay,
                                     now.az));
                     return "17.05.2024;08:15:" + numbers;
                 });
    expect_read_as_the_drive(log_file(in_utf16(text)));
}

TEST(LogDetection, ReadsNmeaCoordinatesKnotsAndMilliG) {
    const auto minutes = [](double deg) {
        return std::floor(deg) * 100 + (deg - std::floor(deg)) * 60;
    };
    const auto text =
        log_text("timestamp\tlat\tlat_dir\tlon\tlon_dir\tspeed_knots\tacc_x [mg]\tacc_y [mg]\t"
                 "acc_z [mg]\tgyro_x [dps]\tgyro_y [dps]\tgyro_z [dps]\n",
                 [&](const Reading& now, const Reading& fix) {
                     return fmt::format(
                         "{:.0f}\t{:.5f}\tN\t{:.5f}\tE\t{:.3f}\t{:.1f}\t{:.1f}\t{:.1f}\t{:.2f}\t"
                         "{:.2f}\t{:.2f}",
                         1715926530000 + now.t_s * 1000,
                         minutes(fix.lat_deg),
                         minutes(fix.lon_deg),
                         fix.v_mps * 3600 / 1852,
                         now.ax / g * 1000,
                         now.ay / g * 1000,
                         now.az / g * 1000,
                         now.wx / deg_in_rad,
                         now.wy / deg_in_rad,
                         now.wz / deg_in_rad);
                 });
    const auto file = log_file(text);
    expect_read_as_the_drive(file);
    EXPECT_EQ(read_trip({.file = file, .member = {}}, everything).meta.t0_utc_s, 1715926530);
}

TEST(LogDetection, ReadsCountsOfAChipAndCoordinatesTimesTenMillion) {
    const auto text = log_text(
        "millis,ax,ay,az,gx,gy,gz,lat,lng,kmph\n", [](const Reading& now, const Reading& fix) {
            const double counts = 16384 / g;
            return fmt::format(
                "{:.0f},{:.0f},{:.0f},{:.0f},{:.0f},{:.0f},{:.0f},{:.0f},{:.0f},{:.1f}",
                5000 + now.t_s * 1000,
                now.ax * counts,
                now.ay * counts,
                now.az * counts,
                now.wx / deg_in_rad * 131,
                now.wy / deg_in_rad * 131,
                now.wz / deg_in_rad * 131,
                fix.lat_deg * 1e7,
                fix.lon_deg * 1e7,
                fix.v_mps * 3.6);
        });
    const auto file = log_file(text);
    expect_read_as_the_drive(file);
    // Nothing shows the unit of the rates: they are left out rather than guessed.
    EXPECT_THAT(read_trip({.file = file, .member = {}}, everything).gyro.t_s, IsEmpty());
}

TEST(LogDetection, ReversesTheAccelerationsOfAnIphone) {
    const auto text = log_text(
        "loggingTime(txt),loggingSample(N),locationLatitude(WGS84),locationLongitude(WGS84),"
        "locationSpeed(m/s),accelerometerAccelerationX(G),accelerometerAccelerationY(G),"
        "accelerometerAccelerationZ(G),motionYaw(rad)\n",
        [](const Reading& now, const Reading& fix) {
            return fmt::format(
                "2024-05-17 08:15:{:06.3f} +0200,1,{:.6f},{:.6f},{:.2f},{:.5f},{:.5f},{:.5f},0.1",
                now.t_s,
                fix.lat_deg,
                fix.lon_deg,
                fix.v_mps,
                -now.ax / g,
                -now.ay / g,
                -now.az / g);
        });
    const auto file = log_file(text);
    expect_read_as_the_drive(file);
    const auto trip = read_trip({.file = file, .member = {}}, everything);
    EXPECT_GT(trip.acc.z.front(), 5);
    EXPECT_EQ(trip.meta.t0_utc_s, 1715926500); // 06:15 UTC
}

TEST(LogDetection, ReadsNamesBelowAPreambleAndUnitsBelowTheNames) {
    const auto text = log_text(
        "\"Format\",\"AiM CSV File\"\n\"Session\",\"track\"\n\n\"Time\",\"GPS Speed\",\"GPS "
        "Latitude\",\"GPS Longitude\",\"VerticalAcc\"\n\"s\",\"km/h\",\"deg\",\"deg\",\"g\"\n\n",
        [](const Reading& now, const Reading& fix) {
            return fmt::format("\"{:.2f}\",\"{:.2f}\",\"{:.6f}\",\"{:.6f}\",\"{:.5f}\"",
                               now.t_s,
                               fix.v_mps * 3.6,
                               fix.lat_deg,
                               fix.lon_deg,
                               now.vertical_mps2 / g);
        });
    const auto file = log_file(text);
    const auto log = detect_log(file);
    ASSERT_TRUE(log);
    EXPECT_THAT(missing_measurements(*log, needs_of_import(), Confidence::sure), IsEmpty());
    EXPECT_NEAR(read_trip({.file = file, .member = {}}, everything).acc.z[3],
                drive()[3].vertical_mps2,
                0.01);
}

TEST(LogDetection, ReadsATableWithoutNamesAsFarAsItsValuesTell) {
    const auto text = log_text("", [](const Reading& now, const Reading&) {
        return fmt::format("{:.0f},{:.3f},{:.3f},{:.3f}", now.t_s * 1000, now.ax, now.ay, now.az);
    });
    const auto log = detect_log(log_file(text));
    ASSERT_TRUE(log);
    ASSERT_TRUE(log->time);
    EXPECT_EQ(log->time->columns.front(), 1U);
    EXPECT_EQ(log->time->format, "ms");
    EXPECT_EQ(sure_mapping(*log), nullptr);
    ASSERT_THAT(log->channels, SizeIs(3)); // whose mean is gravity
    EXPECT_EQ(log->channels[2].channel, "acc_z_mps2");
    EXPECT_EQ(log->channels[2].column, 4U);
    EXPECT_EQ(log->channels[2].unit, "m/s2");
    EXPECT_EQ(log->channels[2].confidence, Confidence::likely);
}

TEST(LogDetection, IsNotSureWhereNamesAndValuesContradict) {
    const auto log_with = [](const std::string& names, double factor) {
        return detect_log(log_file(log_text(names, [&](const Reading& now, const Reading& fix) {
            return fmt::format("{:.2f},{:.4f},{:.4f},{:.4f},{:.6f},{:.6f},{:.2f}",
                               now.t_s,
                               now.ax / g,
                               now.ay / g,
                               now.az / g,
                               fix.lat_deg,
                               fix.lon_deg,
                               fix.v_mps * factor);
        })));
    };
    // 1 g as m/s2
    const auto acc = log_with("t [s],ax [m/s2],ay [m/s2],az [m/s2],lat,lon,speed [m/s]\n", 1);
    EXPECT_THAT(missing_measurements(*acc, needs_of_trace(), Confidence::sure),
                HasSubstr("vertical acceleration"));
    // km/h as m/s: then time or positions may be wrong as well
    const auto speed = log_with("t [s],ax [g],ay [g],az [g],lat,lon,speed [m/s]\n", 3.6);
    EXPECT_EQ(missing_measurements(*speed, needs_of_import(), Confidence::sure),
              "time; speed of the car or of the receiver; position (latitude, longitude)");
}

TEST(LogDetection, IsNotSureWhichWayIsUpWithoutGravity) {
    const auto log =
        detect_log(log_file(log_text("time (s),Linear Acceleration x (m/s^2),Linear Acceleration y "
                                     "(m/s^2),Linear Acceleration z "
                                     "(m/s^2),speed (m/s)\n",
                                     [](const Reading& now, const Reading&) {
                                         return fmt::format("{:.2f},{:.4f},0.1,{:.4f},{:.2f}",
                                                            now.t_s,
                                                            now.ax,
                                                            now.vertical_mps2 - g,
                                                            now.v_mps);
                                     })));
    ASSERT_TRUE(log);
    EXPECT_FALSE(log->has_gravity);
    EXPECT_THAT(missing_measurements(*log, needs_of_trace(), Confidence::sure),
                HasSubstr("vertical acceleration"));
    EXPECT_THAT(missing_measurements(*log, needs_of_trace(), Confidence::likely), IsEmpty());
}

TEST(LogDetection, WritesAMappingThatReadsTheSameTrip) {
    const auto file = log_file(log_text(androsensor_header, androsensor_line));
    const auto mapping_file = written(
        file.parent_path(), "m.toml", mapping_toml(*detect_log(file), Confidence::likely, "*.csv"));
    const auto mapping = std::make_shared<const TripMapping>(read_mapping(mapping_file.string()));
    const auto mapped = read_trip(*TripWalk(file, {.mapping = mapping}).next(), everything);
    const auto detected = read_trip({.file = file, .member = {}}, everything);
    EXPECT_EQ(mapped.sha256, detected.sha256);
    EXPECT_EQ(mapped.acc.t_s, detected.acc.t_s);
    EXPECT_EQ(mapped.acc.z, detected.acc.z);
    EXPECT_EQ(mapped.gyro.x, detected.gyro.x);
    EXPECT_EQ(mapped.rows, detected.rows);
}

TEST(LogDetection, MarksWhatItDidNotFind) {
    const auto log = detect_log(
        log_file(log_text("t [s],temperature,az [g]\n", [](const Reading& now, const Reading&) {
            return fmt::format("{:.2f},20,{:.4f}", now.t_s, now.vertical_mps2 / g);
        })));
    const auto toml = mapping_toml(*log, Confidence::likely, "*.csv");
    EXPECT_THAT(toml, HasSubstr("acc_z_mps2 = {column = \"az [g]\", unit = \"g\"}   # sure"));
    EXPECT_THAT(toml, HasSubstr("# lat_deg = {column = \"?\"}   # not found: latitude"));
    EXPECT_THAT(toml, HasSubstr("# not used: temperature"));
    EXPECT_NO_THROW(parse_mapping(toml, "m.toml"));
    EXPECT_EQ(missing_measurements(*log, needs_of_import(), Confidence::likely),
              "speed of the car or of the receiver; position (latitude, longitude)");
}

TEST(LogDetection, RecognisesTheLoggersOfBuiltInMappings) {
    const auto loggers = fs::path{source_folder()} / "tests/data/loggers";
    EXPECT_EQ(detect_log(loggers / "racechrono.csv")->built_in, "racechrono");
    EXPECT_EQ(detect_log(loggers / "trackaddict.csv")->built_in, "trackaddict");
    const TripSource source{.file = loggers / "trackaddict.csv", .member = {}};
    EXPECT_THAT(read_trip(source, needs_of_match()).fixes, SizeIs(::testing::Gt(2)));
}

/// Coordinates and what stands beside them, with time and speed.
std::string position_log(const std::string& header,
                         const std::function<std::string(const Reading&)>& positions) {
    return log_text(
        "time(ms)," + header + ",speed(km/h)\n", [&](const Reading& now, const Reading& fix) {
            return fmt::format("{:.0f},{},{:.2f}", now.t_s * 1000, positions(fix), fix.v_mps * 3.6);
        });
}

const DetectedChannel& channel_of(const DetectedLog& log, std::string_view name) {
    const auto found = std::ranges::find(log.channels, name, &DetectedChannel::channel);
    EXPECT_NE(found, log.channels.end()) << name;
    return *found;
}

TEST(LogDetection, TakesALetterForAHemisphereOnlyBesideACoordinateWithoutASign) {
    const auto surface =
        detect_log(log_file(position_log("lat,surface,humidity,lon", [](const Reading& fix) {
            return fmt::format("{:.6f},W,40,{:.6f}", fix.lat_deg, fix.lon_deg);
        })));
    EXPECT_FALSE(channel_of(*surface, "lon_deg").hemisphere);
    const auto file = log_file(position_log("lat,N/S,lon,E/W", [](const Reading& fix) {
        return fmt::format("{:.6f},S,{:.6f},E", -fix.lat_deg, fix.lon_deg);
    }));
    EXPECT_FALSE(channel_of(*detect_log(file), "lat_deg").hemisphere);
    EXPECT_NEAR(read_trip({.file = file, .member = {}}, needs_of_match()).fixes[5].at.lat_deg,
                -47.69,
                0.01);
}

TEST(LogDetection, ReadsMinutesOfALongitudeNearGreenwich) {
    const auto file = log_file(position_log("lat,lat_dir,lon,lon_dir", [](const Reading& fix) {
        const double west_deg = 0.3 - (fix.lon_deg - 17.6346);
        return fmt::format("{:.5f},N,{:.5f},W",
                           4700 + (fix.lat_deg - 47) * 60,
                           west_deg * 60); // 00018.00000 as a number
    }));
    EXPECT_EQ(channel_of(*detect_log(file), "lon_deg").unit, "ddmm.mmmm");
    EXPECT_NEAR(
        read_trip({.file = file, .member = {}}, needs_of_match()).fixes[5].at.lon_deg, -0.3, 0.01);
}

TEST(LogDetection, TakesNoCountSinceAnotherYearForADate) {
    const auto log_of = [](const std::string& name, double begin_s) {
        return detect_log(
            log_file(log_text(name + ",lat,lon\n", [&](const Reading& now, const Reading& fix) {
                return fmt::format(
                    "{:.3f},{:.6f},{:.6f}", begin_s + now.t_s, fix.lat_deg, fix.lon_deg);
            })));
    };
    EXPECT_FALSE(log_of("timestamp", 814'000'000)->time->has_date);  // since 2001
    EXPECT_FALSE(log_of("gps_time", 1'479'000'000)->time->has_date); // since 1980
    EXPECT_TRUE(log_of("timestamp", 1'715'926'530)->time->has_date);
}

TEST(LogDetection, IsNotSureOfMinutesAndOfTheVerticalOfATiltedSensor) {
    const auto log = detect_log(log_file(log_text(
        "elapsed minutes,LongAcc(g),LatAcc(g),VertAcc(g)\n", [](const Reading& now, auto&) {
            return fmt::format("{:.6f},{:.4f},{:.4f},{:.4f}",
                               now.t_s / 60,
                               0.866 * now.vertical_mps2 / g,
                               0.0,
                               0.5 * now.vertical_mps2 / g);
        })));
    EXPECT_EQ(log->time->confidence, Confidence::likely);
    EXPECT_EQ(channel_of(*log, "acc_z_mps2").confidence, Confidence::likely);
}

TEST(LogDetection, ConfirmsTheUnitOfACountBySpeedAndPositions) {
    const auto log_of = [](double counts_per_s, const std::string& more, bool has_speed) {
        return detect_log(log_file(
            log_text("time,latitude,longitude" + more + "\n", [&](auto& now, const Reading& fix) {
                return fmt::format("{:.0f},{:.7f},{:.7f},{:.2f}",
                                   now.t_s * counts_per_s,
                                   fix.lat_deg,
                                   fix.lon_deg,
                                   has_speed ? fix.v_mps * 3.6 : 5);
            })));
    };
    for (const auto* const speed : {",speed", ",speed (km/h)"}) {
        const auto ms = log_of(1000, speed, true);
        EXPECT_EQ(unit_words(*ms->time), "ms");
        EXPECT_EQ(ms->time->confidence, Confidence::sure);
        const auto tenths = log_of(10'000, speed, true);
        EXPECT_EQ(unit_words(*tenths->time), "0.1 ms");
        EXPECT_EQ(tenths->time->confidence, Confidence::sure) << tenths->time->reason;
        EXPECT_THAT(missing_measurements(*tenths, needs_of_match(), Confidence::sure), IsEmpty());
    }
    const auto ticks = log_of(10'000, ",temperature", false);
    EXPECT_EQ(ticks->time->confidence, Confidence::likely);
    EXPECT_THAT(ticks->time->reason, HasSubstr("a guess"));
    EXPECT_EQ(sure_mapping(*ticks), nullptr);
}

TEST(LogDetection, ReadsStepsOfATenthOfAMillisecond) {
    const auto file = log_file(log_text("time,lat,lon,speed\n", [](auto& now, auto& fix) {
        return fmt::format(
            "{:.0f},{:.7f},{:.7f},{:.2f}", now.t_s * 10'000, fix.lat_deg, fix.lon_deg, fix.v_mps);
    }));
    EXPECT_THAT(mapping_toml(*detect_log(file), Confidence::sure, "*.csv"),
                HasSubstr("format = \"ms\"\nscale = 0.1\n"));
    const auto trip = read_trip({.file = file, .member = {}}, needs_of_match());
    EXPECT_NEAR(trip.fixes.back().t_s - trip.fixes.front().t_s, seconds - 1, 1e-6);
}

TEST(LogDetection, ReadsFeetPerSecondSquared) {
    const auto file = log_file(log_text(
        "Time (sec), Latitude (deg), Longitude (deg), GPS speed (mph), Accel X (ft/s²), Accel Y "
        "(ft/s²), Accel Z (ft/s²)\n",
        [](auto& now, auto& fix) {
            return fmt::format("{:.3f}, {:.7f}, {:.7f}, {:.2f}, {:.3f}, {:.3f}, {:.3f}",
                               now.t_s,
                               fix.lat_deg,
                               fix.lon_deg,
                               fix.v_mps / 0.44704,
                               now.ax / 0.3048,
                               now.ay / 0.3048,
                               now.az / 0.3048);
        }));
    expect_read_as_the_drive(file);
}

/// Log of a u-blox receiver: its count of milliseconds, whole numbers of 1e-7 degrees and mm/s.
std::string receiver_line(const Reading& now, const Reading& fix) {
    return fmt::format("{:.0f},{:.0f},{:.0f},{:.0f},{:.4f},{:.4f},{:.4f}",
                       203'541'000 + now.t_s * 1000,
                       fix.lon_deg * 1e7,
                       fix.lat_deg * 1e7,
                       fix.v_mps * 1000,
                       now.ax,
                       now.ay,
                       now.az);
}

TEST(LogDetection, ReadsAReceiversTimeOfTheWeekAndMillimetresPerSecond) {
    expect_read_as_the_drive(log_file(log_text("iTOW,lon,lat,gSpeed,ax,ay,az\n", receiver_line)));
}

TEST(LogDetection, TakesNoCentimetresPerSecondToConfirmAGuessedTime) {
    const auto log =
        detect_log(log_file(log_text("ticks,lat,lon,speed\n", [](auto& now, auto& fix) {
            return fmt::format("{:.0f},{:.7f},{:.7f},{:.3f}",
                               now.t_s * 100'000, // 10 us, which as ms makes the car 100 times slow
                               fix.lat_deg,
                               fix.lon_deg,
                               fix.v_mps);
        })));
    ASSERT_TRUE(log && log->time);
    EXPECT_EQ(unit_words(*log->time), "0.01 ms");
    EXPECT_EQ(log->channel("gnss_speed_mps")->unit, "m/s");
}

TEST(LogDetection, TakesBareAxesForALikelyAccelerometer) {
    const auto text = [](double factor) {
        return log_text("Timestamp,X,Y,Z,latitude,longitude,speed (m/s)\n",
                        [=](auto& now, auto& fix) {
                            return fmt::format("{:.3f},{:.4f},{:.4f},{:.4f},{:.7f},{:.7f},{:.3f}",
                                               now.t_s,
                                               now.ax * factor,
                                               now.ay * factor,
                                               now.az * factor,
                                               fix.lat_deg,
                                               fix.lon_deg,
                                               fix.v_mps);
                        });
    };
    const auto log = detect_log(log_file(text(1)));
    ASSERT_NE(log->channel("acc_z_mps2"), nullptr);
    EXPECT_EQ(log->channel("acc_z_mps2")->confidence, Confidence::likely);
    EXPECT_THAT(mapping_toml(*log, Confidence::likely, "*.csv"),
                HasSubstr("acc_z_mps2 = {column = \"Z\", unit = \"m/s2\"}"));
    EXPECT_EQ(detect_log(log_file(text(5)))->channel("acc_z_mps2"), nullptr); // a magnetometer
}

TEST(LogDetection, IsNotSureOfATimeThatContradictsSpeedAndPositions) {
    const auto log = detect_log(log_file(position_log("lat,lon", [](const Reading& fix) {
        return fmt::format("{:.7f},{:.7f}", 47 + 10 * (fix.lat_deg - 47), fix.lon_deg);
    })));
    EXPECT_EQ(log->time->confidence, Confidence::likely);
    EXPECT_THAT(log->time->reason, HasSubstr("contradicts speed or positions"));
    EXPECT_EQ(channel_of(*log, "lat_deg").confidence, Confidence::likely);
}

TEST(LogDetection, IsNotSureOfLatitudeAndLongitudeUnderEachOthersNames) {
    const auto northward = [](const Reading& fix) { return 47.6 + fix.t_s * 12 / 111195; };
    const auto log_of = [&](const std::string& more, bool exchanged) {
        return detect_log(log_file(log_text(
            "time(ms),latitude,longitude" + more + "\n", [&](const Reading& now, auto& fix) {
                const double lat_deg = northward(fix);
                const double lon_deg = 17.6346;
                return fmt::format("{:.0f},{:.7f},{:.7f},{}",
                                   now.t_s * 1000,
                                   exchanged ? lon_deg : lat_deg,
                                   exchanged ? lat_deg : lon_deg,
                                   more == ",course" ? "0.4" : "12.0");
            })));
    };
    for (const auto* const column : {",course", ",GPS speed (m/s)", ",GPS speed"}) {
        const auto as_named = log_of(column, false);
        EXPECT_EQ(channel_of(*as_named, "lat_deg").column, 2U) << column;
        EXPECT_EQ(channel_of(*as_named, "lat_deg").confidence, Confidence::sure) << column;
        const auto exchanged = log_of(column, true);
        EXPECT_EQ(channel_of(*exchanged, "lat_deg").column, 3U) << column;
        EXPECT_EQ(channel_of(*exchanged, "lat_deg").confidence, Confidence::likely) << column;
        EXPECT_THAT(channel_of(*exchanged, "lon_deg").reason, HasSubstr("names of latitude"));
        EXPECT_EQ(sure_mapping(*exchanged), nullptr);
    }
}

TEST(LogDetection, TakesACourseFromEastForNoExchangeOfLatitudeAndLongitude) {
    const auto log = detect_log(log_file(position_log("lat,lon,heading", [](const Reading& fix) {
        return fmt::format("{:.7f},{:.7f},{:.1f}", fix.lat_deg, fix.lon_deg, 90 - fix.course_deg);
    })));
    EXPECT_EQ(channel_of(*log, "lat_deg").column, 2U);
    EXPECT_EQ(channel_of(*log, "lat_deg").confidence, Confidence::sure);
    EXPECT_EQ(channel_of(*log, "course_deg").confidence, Confidence::likely);
}

TEST(LogDetection, TellsTheUnitOfSmallRatesOnlyOfACarThatMoves) {
    const auto log_of = [](double radps_unit, double v_share) {
        return detect_log(log_file(
            log_text("time(ms),wx,wy,wz,lat,lon,speed (m/s)\n", [&](auto& now, const Reading& fix) {
                return fmt::format("{:.0f},{:.4f},{:.4f},{:.4f},{:.7f},{:.7f},{:.2f}",
                                   now.t_s * 1000,
                                   now.wx * radps_unit,
                                   now.wy * radps_unit,
                                   now.wz * radps_unit,
                                   47 + (fix.lat_deg - 47) * v_share,
                                   17 + (fix.lon_deg - 17) * v_share,
                                   fix.v_mps * v_share);
            })));
    };
    EXPECT_EQ(channel_of(*log_of(1, 1), "gyro_z_radps").unit, "rad/s");
    EXPECT_EQ(channel_of(*log_of(1, 1), "gyro_z_radps").confidence, Confidence::sure);
    const auto parked = log_of(2, 0); // deg/s that are as small as rad/s of a drive
    EXPECT_EQ(channel_of(*parked, "gyro_z_radps").unit, "");
    EXPECT_EQ(channel_of(*parked, "gyro_z_radps").confidence, Confidence::likely);
    EXPECT_THAT(channel_of(*parked, "gyro_z_radps").reason, HasSubstr("of a car that stands"));
}

TEST(LogDetection, TakesNoOtherTableForALog) {
    const auto log =
        detect_log(log_file("product;price;count\nbread;3,50;7\nmilk;1,20;2\nsalt;0,80;1\n"));
    ASSERT_TRUE(log);
    EXPECT_EQ(sure_mapping(*log), nullptr);
    EXPECT_FALSE(detect_log(log_file("# macadam-trip 1\nt_s,acc_z_mps2\n0,9.8\n0.1,9.8\n")));
    EXPECT_FALSE(detect_log(log_file("one line of prose\nand another\n")));
}

TEST(TripWalk, TakesDetectedLogsOfAFolderThatHasNoOthers) {
    const auto folder = test_folder();
    written(folder, "a.csv", log_text(androsensor_header, androsensor_line));
    written(folder, "prices.csv", "product;price\nbread;3,50\nmilk;1,20\n");
    TripWalk walk{folder};
    EXPECT_EQ(walk.count(), 1U);
    EXPECT_EQ(walk.next()->file.filename(), "a.csv");
    EXPECT_EQ(walk.first_other_file(), "prices.csv");
    written(folder, "b.trip.csv", "# macadam-trip 1\n");
    TripWalk beside{folder};
    EXPECT_EQ(beside.count(), 1U);
    EXPECT_EQ(beside.next()->file.filename(), "b.trip.csv");
}

TEST(TripWalk, TakesDetectedLogsOfAnArchiveThatHasNoOthers) {
    const auto folder = test_folder();
    const auto text = log_text(androsensor_header, androsensor_line);
    const auto archive = written(folder,
                                 "logs.zip",
                                 archive_of("zip",
                                            {{"readme.txt", "two drives\n"},
                                             {"may/a.csv", text},
                                             {"prices.csv", "a;b\n1;2\n3;4\n"}}));
    TripWalk walk{archive};
    const auto trip = walk.next();
    ASSERT_TRUE(trip);
    EXPECT_EQ(trip->name(), archive.string() + "/may/a.csv");
    const auto plain = log_file(text);
    EXPECT_EQ(read_trip(*trip, everything).acc.z,
              read_trip({.file = plain, .member = {}}, everything).acc.z);
    EXPECT_FALSE(walk.next());
    EXPECT_EQ(walk.other_files(), 2U);

    const auto mixed =
        written(folder,
                "mixed.zip",
                archive_of("zip", {{"a.csv", text}, {"b.trip.csv", "# macadam-trip 1\n"}}));
    TripWalk beside{mixed};
    EXPECT_EQ(beside.next()->member, "b.trip.csv");
    EXPECT_FALSE(beside.next());
}

TEST(TripWalk, ReportsTheSearchOfAFolderAndEndsItOnRequest) {
    const auto folder = test_folder();
    for (const auto* const name : {"a.csv", "b.csv", "c.csv"}) {
        written(folder, name, log_text(androsensor_header, androsensor_line));
    }
    std::stop_source stop;
    std::vector<std::size_t> done;
    const auto report = [&](std::size_t count, std::size_t) {
        done.push_back(count);
        stop.request_stop();
    };
    TripWalk walk{folder, {.search = {.report = report, .stop = stop.get_token()}}};
    EXPECT_THAT(done, ::testing::ElementsAre(1U));
    EXPECT_EQ(walk.count(), 1U);
}

TEST(TripWalk, TakesNamesInCapitalsAndNoTraceForALog) {
    const auto folder = test_folder();
    written(folder, "LOG001.CSV", log_text(androsensor_header, androsensor_line));
    written(folder, "trace.csv", log_text("t_s,lat_deg,lon_deg,iri\n", [](auto& now, auto& fix) {
                return fmt::format("{:.2f},{:.6f},{:.6f},2.5", now.t_s, fix.lat_deg, fix.lon_deg);
            }));
    TripWalk walk{folder};
    EXPECT_EQ(walk.count(), 1U);
    EXPECT_EQ(walk.next()->file.filename(), "LOG001.CSV");
}

TEST(OpenTrip, NamesInspectForATableThatIsNotSure) {
    const auto file = log_file("a,b,c\n1,2,3\n2,2,3\n3,2,3\n");
    EXPECT_THAT(refusal_of([&] { read_trip({.file = file, .member = {}}, needs_of_match()); }),
                HasSubstr("drive.csv: not a Macadam log; read as a CSV file (commas), not found or "
                          "not sure: time; position (latitude, longitude). 'macadam inspect "));
}
