#include "storage/trips/foreign_trip.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/sha256.hpp"
#include "storage/trips/foreign/phone_export.hpp"
#include "storage/trips/foreign/table_reader.hpp"
#include "storage/trips/foreign/text_decoding.hpp"
#include "storage/trips/foreign/trip_files.hpp"
#include "storage/trips/log/trip_assembly.hpp"
#include "storage/trips/mappings/column_mapping.hpp"
#include "storage/trips/signals/can_reader.hpp"
#include "storage/trips/signals/hdf5_reader.hpp"
#include "storage/trips/signals/mdf_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace macadam {

namespace {

// Plausible range of times since 1970; outside of it, the unit is not the stated one.
constexpr double earliest_utc_s = 631152000; // 1990-01-01
constexpr double latest_utc_s = 4102444800;  // 2100-01-01

constexpr double same_time_s = 0.1; // gravity changes slowly; it is logged with each acceleration

double& at(TripRow& row, TripColumn column) {
    return row.value[static_cast<std::size_t>(column)];
}

constexpr TripColumn acc_axes[] = {TripColumn::acc_x, TripColumn::acc_y, TripColumn::acc_z};

/// Channels of all tables, in the form of a header of our own log.
TripHeader header_of(const TripMapping& mapping) {
    TripHeader header;
    for (const auto& table : mapping.tables) {
        for (const auto& channel : table.channels) {
            header.columns.push_back(channel.channel);
        }
    }
    return header;
}

bool gives(const TripHeader& header, const std::string& column) {
    const auto channel = channel_named(column);
    return column == "t_s" || (channel && header.has(*channel));
}

void expect_channels(const TripSource& source,
                     const TripMapping& mapping,
                     const TripHeader& header,
                     const TripNeeds& needs) {
    const auto has = [&](const std::string& column) { return gives(header, column); };
    if (const auto missing = missing_measurements(needs, has); !missing.empty()) {
        throw InputError{fmt::format("{}: read by {}, which gives no {}, expected {}",
                                     source.name(),
                                     source.mapping ? mapping.where : "its sensors",
                                     missing,
                                     missing_columns(needs, has))};
    }
}

/// Corrects a logger's clock for its pauses.
double with_pauses(double t_s, const std::vector<ClockPiece>& clock) {
    const auto after =
        std::upper_bound(clock.begin(), clock.end(), t_s, [](double t, const ClockPiece& p) {
            return t < p.from_s;
        });
    return after == clock.begin() ? t_s : t_s + std::prev(after)->late_s;
}

/// Direction of gravity over time, for accelerations that exclude it.
class Gravity {
public:
    void add(const TripRow& row) {
        if (!row.fault && (t_s_.empty() || row[TripColumn::t_s] > t_s_.back())) {
            t_s_.push_back(row[TripColumn::t_s]);
            force_.push_back(
                {row[TripColumn::acc_x], row[TripColumn::acc_y], row[TripColumn::acc_z]});
        }
    }

    /// Adds gravity to the acceleration of a row, or removes the acceleration if gravity is
    /// unknown.
    TripRow added_to(TripRow row) const {
        const auto after = std::lower_bound(t_s_.begin(), t_s_.end(), row[TripColumn::t_s]);
        auto i = static_cast<std::size_t>(after - t_s_.begin());
        if (i > 0 && (i == t_s_.size() ||
                      row[TripColumn::t_s] - t_s_[i - 1] < t_s_[i] - row[TripColumn::t_s])) {
            --i;
        }
        const bool known =
            i < t_s_.size() && std::abs(t_s_[i] - row[TripColumn::t_s]) <= same_time_s;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            at(row, acc_axes[axis]) +=
                known ? force_[i][axis] : std::numeric_limits<double>::quiet_NaN();
        }
        return row;
    }

    bool empty() const { return t_s_.empty(); }

private:
    std::vector<double> t_s_;
    std::vector<std::array<double, 3>> force_;
};

/// Merges the tables of a trip onto a common clock and into its streams.
class TripMerger {
public:
    TripMerger(const TripMapping& mapping, const TripNeeds& needs, const TripHeader& header)
        : mapping_{mapping}, streams_{needs, header} {}

    template <typename Rows>
    void add(Rows table, bool is_gravity, const std::stop_token& stop) {
        while (auto row = table.next()) {
            if (stop.stop_requested()) {
                throw InputError{fmt::format("{}: reading was stopped", mapping_.where)};
            }
            put_on_clock(*row);
            if (is_gravity) {
                gravity_.add(*row);
                row->fault = row->fault.value_or(RowReason::merged);
                streams_.add(*row);
            } else {
                streams_.add(gravity_.empty() ? *row : gravity_.added_to(*row));
            }
        }
        dated_ = dated_ || table.dated();
    }

    TripLog take() {
        auto trip = streams_.take();
        trip.meta = mapping_.meta;
        // The first time stamp may be an outlier; the first one that was kept is not.
        const double begin_s = first_time(trip);
        shift(trip, -begin_s);
        const double zero_s = base_s_.value_or(0) + begin_s;
        if (dated_) {
            trip.meta.t0_utc_s = zero_s;
        } else if (mapping_.clock_zero_utc_s) {
            trip.meta.t0_utc_s = *mapping_.clock_zero_utc_s + zero_s;
        }
        expect_likely_date(trip.meta);
        return trip;
    }

private:
    void put_on_clock(TripRow& row) {
        auto& t_s = at(row, TripColumn::t_s);
        if (std::isnan(t_s)) {
            return;
        }
        t_s = with_pauses(t_s, mapping_.clock);
        base_s_ = base_s_.value_or(t_s);
        t_s -= *base_s_;
    }

    static double first_time(const TripLog& trip) {
        double first_s = std::numeric_limits<double>::infinity();
        for (const auto* times : {&trip.acc.t_s, &trip.gyro.t_s, &trip.speed.t_s}) {
            first_s = times->empty() ? first_s : std::min(first_s, times->front());
        }
        first_s = trip.fixes.empty() ? first_s : std::min(first_s, trip.fixes.front().t_s);
        return std::isfinite(first_s) ? first_s : 0;
    }

    static void shift(TripLog& trip, double by_s) {
        for (auto* times : {&trip.acc.t_s, &trip.gyro.t_s, &trip.speed.t_s}) {
            std::for_each(times->begin(), times->end(), [=](double& t_s) { t_s += by_s; });
        }
        for (auto& fix : trip.fixes) {
            fix.t_s += by_s;
        }
    }

    void expect_likely_date(const TripMeta& meta) const {
        if (meta.t0_utc_s && !(*meta.t0_utc_s > earliest_utc_s && *meta.t0_utc_s < latest_utc_s)) {
            throw InputError{fmt::format("{}: its times begin {:.0f} s after 1970, expected a "
                                         "date from 1990 to 2100; the unit may differ",
                                         mapping_.where,
                                         *meta.t0_utc_s)};
        }
    }

    const TripMapping& mapping_;
    TripStreams streams_;
    Gravity gravity_;
    std::optional<double> base_s_;
    bool dated_ = false;
};

/// Last component of a trip's name, without suffixes of archives and tables.
std::string trip_id_of(const TripSource& source) {
    auto name = source.member.empty() ? source.file.filename().string() : source.member;
    while (name.ends_with('/')) {
        name.pop_back();
    }
    name = name.substr(name.rfind('/') + 1);
    for (const auto* const suffix : {".gz",
                                     ".zst",
                                     ".tgz",
                                     ".tar",
                                     ".zip",
                                     ".csv",
                                     ".txt",
                                     ".log",
                                     ".asc",
                                     ".mf4",
                                     ".h5",
                                     ".hdf5"}) {
        if (name.ends_with(suffix) && name != suffix) {
            name.erase(name.size() - std::string_view{suffix}.size());
        }
    }
    return name;
}

} // namespace

bool is_foreign(const TripSource& source) {
    return !source.files.empty();
}

std::string foreign_sha256(const TripSource& source) {
    constexpr std::size_t block = 1 << 20;
    auto files = source.mapping ? source.files : used_files(source);
    std::sort(files.begin(), files.end());
    std::vector<char> buffer(block);
    Sha256 sha256;
    for (const auto& file : files) {
        const auto bytes = bytes_of_file(source, file);
        while (const auto count = bytes->read(buffer)) {
            sha256.add({buffer.data(), count});
        }
    }
    return sha256.hex();
}

TripLog
read_foreign_trip(const TripSource& source, const TripNeeds& needs, const std::stop_token& stop) {
    const auto mapping = source.mapping ? *source.mapping : mapping_of_export(source);
    const auto header = header_of(mapping);
    if (!source.mapping) {
        expect_files_of_export(source, needs);
    }
    expect_channels(source, mapping, header, needs);

    TripMerger collector{mapping, needs, header};
    for (std::size_t i = 0; i < mapping.tables.size(); ++i) {
        const auto& table = mapping.tables[i];
        const auto& file = source.mapping ? source.files[i] : table.file;
        const auto name = name_of_file(source, file);
        switch (table.format) {
        case LogFormat::table: {
            TextLines lines{decoded(bytes_of_file(source, file), table.encoding, name), name};
            collector.add(TableReader{std::move(lines), table, name}, table.is_gravity, stop);
            break;
        }
        case LogFormat::can:
            collector.add(read_can({bytes_of_file(source, file), name}, table, name), false, stop);
            break;
        case LogFormat::hdf5:
            collector.add(read_hdf5(text_of_file(source, file), table, name), false, stop);
            break;
        case LogFormat::mdf:
            collector.add(
                (table.dbc ? read_mdf_frames : read_mdf)(text_of_file(source, file), table, name),
                false,
                stop);
            break;
        }
    }
    auto trip = collector.take();
    trip.meta.trip_id = trip_id_of(source);
    return trip;
}

} // namespace macadam
