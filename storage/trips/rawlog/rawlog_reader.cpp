#include "storage/trips/rawlog/rawlog_reader.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/plugin_library.hpp"
#include "storage/text/text.hpp"
#include "storage/trips/log/trip_assembly.hpp"
#include "storage/trips/log/trip_meta.hpp"
#include "storage/trips/log/trip_row.hpp"
#include "storage/trips/rawlog/rawlog_layout.hpp"
#include "storage/trips/rawlog/rawlog_objects.hpp"
#include "storage/trips/rawlog/rawlog_plugin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace macadam {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double longest_odometry_step_s = 2; // poses further apart do not determine the speed

/// Observations of a rawlog, and for every object the index of its observation, or -1.
struct Content {
    std::vector<RawlogObservation> observations;
    std::vector<std::ptrdiff_t> objects;
    std::map<std::string, std::size_t> classes; ///< number of objects per class
    std::optional<TripMeta> head;
};

/// Parses the lines "# key: value" of a comment like a log header.
TripMeta meta_in(std::string_view text, const std::string& where) {
    std::vector<MetaLine> lines;
    while (!text.empty()) {
        const auto line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        const auto colon = line.find(':');
        if (line.starts_with('#') && colon != std::string_view::npos) {
            lines.push_back({where,
                             std::string{trimmed(line.substr(1, colon - 1))},
                             std::string{trimmed(line.substr(colon + 1))}});
        }
    }
    return parse_meta(lines);
}

Content read_objects(std::unique_ptr<ByteStream> bytes, const std::string& name) {
    auto* const decode = plugin_function<RawlogDecode>("macadam_rawlog.so", rawlog_decode_name);
    RawlogObjects objects{std::move(bytes), name};
    Content content;
    const auto take = [&](RawlogObservation observation) {
        const auto* const comment = std::get_if<RawlogComment>(&observation.what);
        if (comment == nullptr) {
            content.objects.push_back(static_cast<std::ptrdiff_t>(content.observations.size()));
            content.observations.push_back(std::move(observation));
            return;
        }
        content.objects.push_back(-1);
        if (comment->text.starts_with(rawlog_head_mark)) {
            content.head = meta_in(comment->text, objects.where());
        }
    };
    while (const auto object = objects.next()) {
        ++content.classes[object->name];
        if (object->kind == RawlogClass::other) {
            content.objects.push_back(-1);
            continue;
        }
        const auto shorter = without_topcon(object->bytes);
        try {
            decode(shorter ? *shorter : object->bytes, take);
        } catch (const InputError& error) {
            throw InputError{fmt::format(
                "{}: MRPT cannot read this {}: {}", objects.where(), object->name, error.what())};
        }
    }
    return content;
}

/// Sensor with the most observations of each kind; of equals, the first.
std::map<std::size_t, std::string> chosen_labels(const std::vector<RawlogObservation>& all) {
    std::map<std::size_t, std::map<std::string, std::size_t>> counts;
    for (const auto& each : all) {
        ++counts[each.what.index()][each.label];
    }
    std::map<std::size_t, std::string> chosen;
    for (const auto& each : all) {
        const auto& of_kind = counts[each.what.index()];
        const auto [best, is_first] = chosen.try_emplace(each.what.index(), each.label);
        if (!is_first && of_kind.at(each.label) > of_kind.at(best->second)) {
            best->second = each.label;
        }
    }
    return chosen;
}

/// Meta data of a trip without a header.
TripMeta meta_without_head(const std::vector<RawlogObservation>& all) {
    TripMeta meta;
    for (const auto& each : all) {
        if (each.utc_ticks && *each.utc_ticks > 0) { // clocks before 1970 were never set
            meta.t0_utc_s = static_cast<double>(*each.utc_ticks) / rawlog_ticks_per_s;
            break;
        }
    }
    for (const auto& each : all) {
        if (const auto* const imu = std::get_if<RawlogImu>(&each.what)) {
            if (imu->roll_pitch_yaw_deg != std::array<double, 3>{}) {
                meta.frame = Frame::sensor;
                meta.frame_stated = true;
                meta.mount_rpy_deg = imu->roll_pitch_yaw_deg;
            }
            break;
        }
    }
    return meta;
}

/// Speeds from consecutive poses, each valid at the midpoint in time.
class Poses {
public:
    struct Speed {
        double t_s;
        double speed_mps;
    };

    std::optional<Speed> add(double t_s, const RawlogOdometry& now) {
        const auto before = std::exchange(before_, Pose{t_s, now});
        const double step_s = before ? t_s - before->t_s : 0;
        if (!(step_s > 0 && step_s <= longest_odometry_step_s)) {
            return std::nullopt;
        }
        const double east_m = now.x_m - before->at.x_m;
        const double north_m = now.y_m - before->at.y_m;
        const bool ahead =
            east_m * std::cos(now.heading_rad) + north_m * std::sin(now.heading_rad) >= 0;
        const double way_m = std::hypot(east_m, north_m);
        return Speed{(before->t_s + t_s) / 2, (ahead ? way_m : -way_m) / step_s};
    }

private:
    struct Pose {
        double t_s;
        RawlogOdometry at;
    };
    std::optional<Pose> before_;
};

/// Converts observations to rows of a log.
class Rows {
public:
    explicit Rows(const TripMeta& meta)
        : t0_ticks_{std::llround(meta.t0_utc_s.value_or(0) * rawlog_ticks_per_s)},
          accuracy_per_hdop_m_{unknown} {
        if (const auto found = meta.other.find(rawlog_accuracy_key); found != meta.other.end()) {
            accuracy_per_hdop_m_ = parse_number(found->second).value_or(unknown);
        }
    }

    TripRow row_of(const RawlogObservation& observation) {
        TripRow row = empty_row();
        if (!observation.utc_ticks) {
            return row;
        }
        set(row,
            TripColumn::t_s,
            static_cast<double>(*observation.utc_ticks - t0_ticks_) / rawlog_ticks_per_s);
        std::visit([&](const auto& what) { fill(row, what); }, observation.what);
        return row;
    }

    static TripRow row_without(RowReason reason) {
        auto row = empty_row();
        row.fault = reason;
        return row;
    }

private:
    static TripRow empty_row() {
        TripRow row;
        row.value.fill(unknown);
        return row;
    }

    static void set(TripRow& row, TripColumn column, double value) {
        row.value[static_cast<std::size_t>(column)] = value;
    }

    static void fill(TripRow& row, const RawlogImu& imu) {
        set(row, TripColumn::acc_x, imu.acc_mps2[0]);
        set(row, TripColumn::acc_y, imu.acc_mps2[1]);
        set(row, TripColumn::acc_z, imu.acc_mps2[2]);
        set(row, TripColumn::gyro_x, imu.gyro_radps[0]);
        set(row, TripColumn::gyro_y, imu.gyro_radps[1]);
        set(row, TripColumn::gyro_z, imu.gyro_radps[2]);
    }

    void fill(TripRow& row, const RawlogFix& fix) const {
        set(row, TripColumn::lat, fix.lat_deg);
        set(row, TripColumn::lon, fix.lon_deg);
        set(row, TripColumn::gnss_speed, fix.speed_mps);
        set(row, TripColumn::course, fix.course_deg);
        set(row, TripColumn::hacc, fix.hdop * accuracy_per_hdop_m_);
        set(row, TripColumn::gnss_fix, fix.quality);
        set(row, TripColumn::gnss_utc, fix.day_time_s);
    }

    void fill(TripRow& row, const RawlogOdometry& odometry) {
        const auto t_s = row[TripColumn::t_s];
        if (!std::isnan(odometry.speed_mps)) {
            set(row, TripColumn::speed, odometry.speed_mps);
        } else if (const auto speed = poses_.add(t_s, odometry)) {
            set(row, TripColumn::t_s, speed->t_s);
            set(row, TripColumn::speed, speed->speed_mps);
        }
    }

    static void fill(TripRow& /*row*/, const RawlogComment& /*comment*/) {}

    std::int64_t t0_ticks_;
    double accuracy_per_hdop_m_;
    Poses poses_;
};

/// Columns of a rawlog, which has no header row: those with a number in any row.
class Columns {
public:
    void add(const TripRow& row) {
        for (std::size_t i = 0; i < occurs_.size(); ++i) {
            occurs_[i] = occurs_[i] || !std::isnan(row.value[i]);
        }
    }

    bool has(const std::string& name) const {
        const auto column = channel_named(name);
        return column && occurs_[static_cast<std::size_t>(*column)];
    }

private:
    std::array<bool, trip_column_count> occurs_{};
};

void expect_columns(const Columns& columns,
                    const TripNeeds& needs,
                    const Content& content,
                    const std::string& name) {
    const auto missing =
        missing_measurements(needs, [&](const std::string& column) { return columns.has(column); });
    if (missing.empty()) {
        return;
    }
    std::vector<std::string> held;
    for (const auto& [kind, count] : content.classes) {
        held.push_back(fmt::format("{} {}", count, kind));
    }
    throw InputError{fmt::format(
        "{}: contains {}, expected also messages for {}", name, fmt::join(held, ", "), missing)};
}

} // namespace

TripLog
read_rawlog(std::unique_ptr<ByteStream> bytes, const std::string& name, const TripNeeds& needs) {
    auto content = read_objects(std::move(bytes), name);
    const auto& observations = content.observations;
    const auto meta = content.head ? *content.head : meta_without_head(observations);
    const auto labels = chosen_labels(observations);

    TripStreams streams{needs, {.columns = {TripColumn::speed}, .names = {}, .unknown = {}}};
    Columns columns;
    Rows rows{meta};
    for (const auto object : content.objects) {
        const auto* const observation =
            object < 0 ? nullptr : &observations[static_cast<std::size_t>(object)];
        if (observation == nullptr || observation->label != labels.at(observation->what.index())) {
            streams.add(Rows::row_without(RowReason::unused_channel));
            continue;
        }
        const auto row = rows.row_of(*observation);
        columns.add(row);
        streams.add(row);
    }
    expect_columns(columns, needs, content, name);
    auto trip = streams.take();
    trip.meta = meta;
    trip.meta.other.erase(rawlog_accuracy_key);
    return trip;
}

} // namespace macadam
