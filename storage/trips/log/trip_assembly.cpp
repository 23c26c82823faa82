#include "storage/trips/log/trip_assembly.hpp"

#include "storage/trips/log/longest_increasing_subsequence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace macadam {

namespace {

// Limits far beyond any car and sensor; larger values are errors of the log.
constexpr double max_acc_mps2 = 1000;
constexpr double max_gyro_radps = 100;
constexpr double max_speed_mps = 1000;
constexpr double max_time_s = 1e10; // a double still resolves microseconds

constexpr double earth_m = 4e7; // once around

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

bool is_reason(std::uint8_t contribution) {
    return contribution >= code(RowReason::wrong_cell_count);
}

TripColumn next(TripColumn column, int places) {
    return static_cast<TripColumn>(static_cast<int>(column) + places);
}

/// Tests whether values are equal, or both unknown.
bool same(double a, double b) {
    return a == b || (std::isnan(a) && std::isnan(b));
}

double known_if(bool condition, double value) {
    return condition ? value : unknown;
}

GnssFix fix_in(const TripRow& row) {
    const double speed = row[TripColumn::gnss_speed];
    const double course = row[TripColumn::course];
    const double accuracy = row[TripColumn::hacc];
    return {.t_s = row[TripColumn::t_s],
            .at = {row[TripColumn::lat], row[TripColumn::lon]},
            .speed_mps = static_cast<float>(known_if(speed >= 0 && speed <= max_speed_mps, speed)),
            .course_deg = static_cast<float>(known_if(course >= 0 && course <= 360, course)),
            .accuracy_m =
                static_cast<float>(known_if(accuracy >= 0 && accuracy <= earth_m, accuracy))};
}

bool has_place(const GnssFix& fix) {
    return !std::isnan(fix.at.lat_deg) && !std::isnan(fix.at.lon_deg);
}

/// Tests for a valid position; receivers without a fix write zeros or invalid numbers.
bool is_on_globe(const GeoPoint& at) {
    return std::abs(at.lat_deg) <= 90 && std::abs(at.lon_deg) <= 180 &&
           (at.lat_deg != 0 || at.lon_deg != 0);
}

bool says_the_same(const GnssFix& a, const GnssFix& b) {
    return same(a.at.lat_deg, b.at.lat_deg) && same(a.at.lon_deg, b.at.lon_deg) &&
           same(a.speed_mps, b.speed_mps) && same(a.course_deg, b.course_deg);
}

/// Keeps the marked `values`, in their order.
template <typename Value>
void keep(const std::vector<std::uint8_t>& members, std::vector<Value>& values) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < members.size(); ++i) {
        if (members[i] != 0) {
            values[kept++] = values[i];
        }
    }
    values.resize(kept);
}

void keep(const std::vector<std::uint8_t>& members, TriaxialSamples& samples) {
    keep(members, samples.t_s);
    keep(members, samples.x);
    keep(members, samples.y);
    keep(members, samples.z);
}

/// Clears the flag of rows whose sample the sensor's stream dropped.
void readmit(const std::vector<std::uint8_t>& members,
             std::uint8_t flag,
             std::vector<std::uint8_t>& rows) {
    std::size_t sample = 0;
    for (auto& row : rows) {
        if (!is_reason(row) && (row & flag) != 0 && members[sample++] == 0) {
            row = static_cast<std::uint8_t>(row & ~flag);
            row = row == 0 ? code(RowReason::time_not_increasing) : row;
        }
    }
}

} // namespace

TripStreams::TripStreams(const TripNeeds& needs, const TripHeader& header)
    : needs_{needs}, wheels_stand_for_speed_{!header.has(TripColumn::speed)}, last_fix_utc_s_{
                                                                                  unknown} {
    trip_.unknown_columns = header.unknown;
}

TripLog TripStreams::take() {
    const auto put_in_order =
        [&](const std::vector<double>& t_s, std::uint8_t flag, auto& samples) {
            const auto members = longest_increasing_subsequence(t_s);
            if (std::find(members.begin(), members.end(), 0) != members.end()) {
                readmit(members, flag, trip_.rows);
                keep(members, samples);
            }
        };
    put_in_order(trip_.acc.t_s, row_content::acc, trip_.acc);
    put_in_order(trip_.gyro.t_s, row_content::gyro, trip_.gyro);
    put_in_order(times_of(trip_.fixes), row_content::fix, trip_.fixes);
    const auto members = longest_increasing_subsequence(trip_.speed.t_s);
    readmit(members, row_content::speed, trip_.rows);
    keep(members, trip_.speed.t_s);
    keep(members, trip_.speed.speed_mps);
    return std::move(trip_);
}

TripLog TripStreams::take_rows() {
    return std::exchange(trip_, TripLog{});
}

void TripStreams::add(const TripRow& row) {
    trip_.rows.push_back(row.fault ? code(*row.fault) : contribution_of(row));
}

std::uint8_t TripStreams::contribution_of(const TripRow& row) {
    const double t_s = row[TripColumn::t_s];
    if (std::isnan(t_s)) {
        return code(RowReason::no_time);
    }
    if (std::abs(t_s) > max_time_s) {
        return code(RowReason::out_of_range);
    }
    const std::array<RowContribution, 4> contributions{
        add_acc(row), add_gyro(row), add_speed(row), add_fix(row)};
    std::uint8_t flags = 0;
    std::uint8_t reason = code(RowReason::no_sample);
    for (const auto contribution : contributions) {
        if (!is_reason(contribution)) {
            flags |= contribution;
        } else if (reason == code(RowReason::no_sample) ||
                   reason == code(RowReason::unused_channel)) {
            reason = contribution; // first fault; otherwise the channel is not needed
        }
    }
    return flags != 0 ? flags : reason;
}

TripStreams::RowContribution TripStreams::add_triaxial(TriaxialSamples& to,
                                                       const TripRow& row,
                                                       TripColumn x,
                                                       RowContribution flag) const {
    const std::array<double, 3> axes{row[x], row[next(x, 1)], row[next(x, 2)]};
    const bool is_acc = flag == row_content::acc;
    if (std::all_of(axes.begin(), axes.end(), [](double a) { return std::isnan(a); })) {
        return 0;
    }
    if (!(is_acc ? needs_.acc : needs_.gyro)) {
        return code(RowReason::unused_channel);
    }
    const double most = is_acc ? max_acc_mps2 : max_gyro_radps;
    if (std::any_of(axes.begin(), axes.end(), [&](double a) { return std::abs(a) > most; })) {
        return code(RowReason::out_of_range);
    }
    to.t_s.push_back(row[TripColumn::t_s]);
    to.x.push_back(static_cast<float>(axes[0]));
    to.y.push_back(static_cast<float>(axes[1]));
    to.z.push_back(static_cast<float>(axes[2]));
    return flag;
}

TripStreams::RowContribution TripStreams::add_acc(const TripRow& row) {
    return add_triaxial(trip_.acc, row, TripColumn::acc_x, row_content::acc);
}

TripStreams::RowContribution TripStreams::add_gyro(const TripRow& row) {
    return add_triaxial(trip_.gyro, row, TripColumn::gyro_x, row_content::gyro);
}

double TripStreams::speed_in(const TripRow& row) const {
    if (!wheels_stand_for_speed_) {
        return row[TripColumn::speed];
    }
    double sum = 0;
    int wheels = 0;
    for (int i = 0; i < 4; ++i) {
        if (const double v = row[next(TripColumn::wheel_fl, i)]; !std::isnan(v)) {
            sum += v;
            ++wheels;
        }
    }
    return wheels == 0 ? unknown : sum / wheels;
}

TripStreams::RowContribution TripStreams::add_speed(const TripRow& row) {
    const double speed = speed_in(row);
    auto& to = trip_.speed;
    if (std::isnan(speed)) {
        // With a speed column, wheel speeds are redundant.
        const bool wheels =
            !std::isnan(row[TripColumn::wheel_fl]) || !std::isnan(row[TripColumn::wheel_fr]) ||
            !std::isnan(row[TripColumn::wheel_rl]) || !std::isnan(row[TripColumn::wheel_rr]);
        return wheels ? code(RowReason::unused_channel) : RowContribution{0};
    }
    if (!needs_.speed) {
        return code(RowReason::unused_channel);
    }
    if (std::abs(speed) > max_speed_mps) {
        return code(RowReason::out_of_range);
    }
    to.t_s.push_back(row[TripColumn::t_s]);
    to.speed_mps.push_back(static_cast<float>(speed));
    return row_content::speed;
}

TripStreams::RowContribution TripStreams::add_fix(const TripRow& row) {
    auto fix = fix_in(row);
    const bool said_something = !std::isnan(fix.at.lat_deg) || !std::isnan(fix.at.lon_deg) ||
                                !std::isnan(row[TripColumn::gnss_speed]);
    if (!said_something) {
        return 0;
    }
    if (!needs_.fixes) {
        return code(RowReason::unused_channel);
    }
    if (!is_on_globe(fix.at)) { // also if one coordinate is missing
        fix.at = {unknown, unknown};
    }
    const bool lost = row[TripColumn::gnss_fix] == 0;
    if (lost || (!has_place(fix) && std::isnan(fix.speed_mps))) {
        return code(RowReason::out_of_range);
    }
    const double utc_s = row[TripColumn::gnss_utc];
    if (last_fix_ && fix.t_s > last_fix_->t_s && says_the_same(fix, *last_fix_) &&
        same(utc_s, last_fix_utc_s_)) {
        return code(RowReason::repeated_fix);
    }
    trip_.fixes.push_back(fix);
    last_fix_ = fix;
    last_fix_utc_s_ = utc_s;
    return row_content::fix;
}

} // namespace macadam
