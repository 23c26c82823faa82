#include "storage/trips/signals/signal_rows.hpp"

#include "estimator/common/error.hpp"
#include "storage/text/text.hpp"
#include "storage/trips/foreign/axes.hpp"
#include "storage/trips/log/longest_increasing_subsequence.hpp"
#include "storage/trips/mappings/column_units.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace macadam {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double max_gap_s = 0.1;
constexpr double max_gap_of_fix_s = 2.5;
constexpr std::size_t max_samples = std::size_t{1} << 28; // 4 GiB

using C = TripColumn;

/// Columns that belong together; the first that has samples leads.
constexpr std::array<C, 3> acc{C::acc_z, C::acc_y, C::acc_x};
constexpr std::array<C, 3> gyro{C::gyro_z, C::gyro_x, C::gyro_y};
constexpr std::array<C, 7> fix{
    C::lat, C::lon, C::gnss_speed, C::course, C::hacc, C::gnss_fix, C::gnss_utc};

std::size_t index(TripColumn column) {
    return static_cast<std::size_t>(column);
}

bool is_of_fix(TripColumn column) {
    return std::ranges::find(fix, column) != fix.end();
}

/// Drops the samples whose times go back, whichever of them are wrong.
template <typename Series>
void keep_increasing(Series& series) {
    const auto kept = longest_increasing_subsequence(series.t_s);
    std::size_t count = 0;
    for (std::size_t i = 0; i < kept.size(); ++i) {
        if (kept[i] != 0) {
            series.t_s[count] = series.t_s[i];
            series.value[count++] = series.value[i];
        }
    }
    series.t_s.resize(count);
    series.value.resize(count);
}

bool is_interpolated(TripColumn column) {
    return !is_of_fix(column) || column == C::lat || column == C::lon;
}

} // namespace

void SignalRows::take_unit(std::size_t channel, std::string_view unit, const std::string& name) {
    auto& mapped = mapping_.channels[channel];
    if (mapped.unit_stated || unit.empty()) {
        return;
    }
    const auto factor = unit_factor(mapped.channel, unit);
    if (!factor) {
        throw InputError{fmt::format("{}: the signal {} is in {}, which is no unit of {}; state a "
                                     "unit in the mapping",
                                     name,
                                     in_quotes(mapped.column.pattern),
                                     in_quotes(unit),
                                     name_of(mapped.channel))};
    }
    mapped.scale *= *factor;
}

void SignalRows::add(double t_s, std::span<const Value> values) {
    Record record{.t_s = t_s,
                  .first_sample = static_cast<std::uint32_t>(samples_.size()),
                  .count = 0,
                  .reason = 0};
    if (samples_.size() + values.size() > max_samples) {
        throw InputError{mapping_.file + ": has too many samples, expected at most 2^28"};
    }
    for (const auto& [channel, value] : values) {
        const auto& mapped = mapping_.channels[channel];
        if (std::isfinite(value) &&
            std::ranges::find(mapped.invalid, value) == mapped.invalid.end()) {
            samples_.push_back({mapped.channel, mapped.scale * value + mapped.offset});
            ++record.count;
        }
    }
    records_.push_back(record);
}

void SignalRows::add(RowReason reason) {
    records_.push_back({.t_s = 0, .first_sample = 0, .count = 0, .reason = code(reason)});
}

std::span<const SignalRows::Sample> SignalRows::samples_of(const Record& record) const {
    return std::span{samples_}.subspan(record.count == 0 ? 0 : record.first_sample, record.count);
}

/// Finds which columns are never in one record with the column that leads them.
void SignalRows::find_leaders() {
    std::array<std::size_t, trip_column_count> count{};
    for (const auto& sample : samples_) {
        ++count[index(sample.column)];
    }
    const auto lead = [&](std::span<const TripColumn> group) {
        const auto leader =
            std::ranges::find_if(group, [&](TripColumn c) { return count[index(c)] > 0; });
        for (auto follower = leader; follower != group.end(); ++follower) {
            if (follower != leader && count[index(*follower)] > 0) {
                leader_[index(*follower)] = *leader;
            }
        }
    };
    lead(acc);
    lead(gyro);
    lead(fix);
    for (const auto& record : records_) {
        const auto samples = samples_of(record);
        for (const auto& sample : samples) { // together once, together always
            auto& leader = leader_[index(sample.column)];
            if (leader && std::ranges::find(samples, *leader, &Sample::column) != samples.end()) {
                leader = std::nullopt;
            }
        }
    }
}

bool SignalRows::follows(TripColumn column) const {
    return leader_[index(column)].has_value();
}

void SignalRows::finish() {
    find_leaders();
    for (const auto& record : records_) {
        for (const auto& sample : samples_of(record)) {
            auto& series = series_[index(sample.column)];
            if (follows(sample.column)) {
                series.t_s.push_back(record.t_s);
                series.value.push_back(sample.value);
            }
        }
    }
    for (auto& series : series_) {
        keep_increasing(series);
    }
}

/// Value of a following column; NaN too far from its samples.
double SignalRows::at(TripColumn column, double t_s) const {
    const auto& [times_s, values] = series_[index(column)];
    const double gap_s = is_of_fix(column) ? max_gap_of_fix_s : max_gap_s;
    const auto after = std::ranges::lower_bound(times_s, t_s);
    const auto i = static_cast<std::size_t>(after - times_s.begin());
    const bool is_between = i > 0 && i < times_s.size();
    const auto joined = [&](double share) {
        const double step = values[i] - values[i - 1];
        return column == C::lon // the short way round
                   ? std::remainder(values[i - 1] + share * std::remainder(step, 360), 360)
                   : values[i - 1] + share * step;
    };
    if (i < times_s.size() && times_s[i] == t_s) {
        return values[i];
    }
    if (is_interpolated(column)) {
        return is_between && times_s[i] - times_s[i - 1] <= gap_s
                   ? joined((t_s - times_s[i - 1]) / (times_s[i] - times_s[i - 1]))
                   : unknown;
    }
    const bool is_before =
        i == times_s.size() || (is_between && t_s - times_s[i - 1] < times_s[i] - t_s);
    const std::size_t nearest = is_before ? i - 1 : i;
    return nearest < times_s.size() && std::abs(times_s[nearest] - t_s) <= gap_s / 2
               ? values[nearest]
               : unknown;
}

TripRow SignalRows::row_of(const Record& record) const {
    TripRow row;
    row.value.fill(unknown);
    if (record.reason != 0) {
        row.fault = static_cast<RowReason>(record.reason);
        return row;
    }
    row.value[index(C::t_s)] = record.t_s + mapping_.time.shift_s;
    bool follows_only = record.count > 0;
    for (const auto& sample : samples_of(record)) {
        if (follows(sample.column)) {
            continue;
        }
        follows_only = false;
        row.value[index(sample.column)] = sample.value;
        for (std::size_t i = 0; i < leader_.size(); ++i) {
            if (leader_[i] == sample.column) {
                row.value[i] = at(static_cast<TripColumn>(i), record.t_s);
            }
        }
    }
    if (follows_only) {
        row.fault = RowReason::merged;
        return row;
    }
    return in_vehicle_axes(row, mapping_.axes);
}

std::optional<TripRow> SignalRows::next() {
    return next_ < records_.size() ? std::optional{row_of(records_[next_++])} : std::nullopt;
}

} // namespace macadam
