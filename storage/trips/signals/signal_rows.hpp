#pragma once

#include "storage/trips/log/trip_row.hpp"
#include "storage/trips/mappings/column_mapping.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Joins the signals of a log, each with its own times, to rows. Each record of the log (a frame, a
/// record of a channel group, a line of a dataset) is a row.
///
/// The axes of an accelerometer or gyro, and the numbers of a fix, belong together. Where they come
/// in different records, the first that has any samples of acc_z, acc_y, acc_x (gyro_z, gyro_x,
/// gyro_y; lat) leads: the others are interpolated at its times, and their records, if they have
/// nothing else, are `merged`. Interpolation is linear (of speed, course and quality of a fix: the
/// nearest), between samples at most 0.1 s apart, of a fix 2.5 s.
class SignalRows {
public:
    /// Value of a channel, by its index in TableMapping::channels.
    struct Value {
        std::uint16_t channel;
        double value; ///< of the signal, before the mapping
    };

    explicit SignalRows(const TableMapping& mapping) : mapping_{mapping} {}

    /// Takes the unit that a signal states itself, unless the mapping does.
    ///
    /// \throws InputError  if it is no unit of that channel.
    void take_unit(std::size_t channel, std::string_view unit, const std::string& name);

    /// Adds a record. Values that the mapping calls invalid, and numbers that are not finite, are
    /// no samples.
    void add(double t_s, std::span<const Value> values);

    void add(RowReason reason); ///< a record without a signal

    /// Ends the log; the rows follow.
    void finish();

    std::optional<TripRow> next();

    bool dated() const { return dated_; }
    void set_dated() { dated_ = true; } ///< times count from 1970

    std::size_t sample_count() const { return samples_.size(); }

private:
    struct Sample {
        TripColumn column;
        double value;
    };
    struct Record {
        double t_s;
        std::uint32_t first_sample;
        std::uint8_t count;
        std::uint8_t reason; ///< 0: none
    };
    /// Samples of a column whose record does not have the leading one.
    struct Series {
        std::vector<double> t_s;
        std::vector<double> value;
    };

    std::span<const Sample> samples_of(const Record& record) const;
    void find_leaders();
    bool follows(TripColumn column) const;
    double at(TripColumn column, double t_s) const;
    TripRow row_of(const Record& record) const;

    TableMapping mapping_; ///< with the units that signals state
    std::vector<Record> records_;
    std::vector<Sample> samples_;
    std::array<std::optional<TripColumn>, trip_column_count> leader_{}; ///< of a following column
    std::array<Series, trip_column_count> series_{};
    std::size_t next_ = 0;
    bool dated_ = false;
};

} // namespace macadam
