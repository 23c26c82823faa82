#pragma once

#include "estimator/common/trip.hpp"
#include "storage/trips/log/trip_row.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Which column of a foreign table is meant: by its name, in which '*' stands for any letters and
/// case does not count, or by its number from 1, where names occur twice or not at all.
struct ColumnName {
    std::string pattern;
    std::size_t number = 0; ///< 0: by name
};

enum class TimeFormat : std::uint8_t {
    number,         ///< a count of `unit_s`
    clock,          ///< hh:mm:ss, with or without a fraction
    compact_clock,  ///< hhmmss as one number
    day_month_year, ///< dd/mm/yyyy hh:mm:ss, whatever stands between
    month_day_year,
    year_month_day, ///< ISO 8601, with T or a blank, with or without a zone
};

/// How a table says when a row was.
struct TimeMapping {
    std::vector<ColumnName> columns; ///< joined by a blank: a date and a time may be two
    TimeFormat format = TimeFormat::number;
    double unit_s = 1;
    bool since_1970 = false;            ///< numbers count from 1970-01-01T00:00:00Z
    std::optional<double> utc_offset_s; ///< local time minus UTC, where the text has no zone
    std::optional<double> fraction_s;   ///< unit of what follows the seconds; none: decimals
    double shift_s = 0;                 ///< to be added: a clock that is known to be off
};

/// A column that is a channel of ours: value = scale * cell + offset.
struct ChannelMapping {
    TripColumn channel;
    ColumnName column;
    double scale = 1; ///< with unit and sign
    double offset = 0;
    std::vector<double> invalid; ///< cells that mean "none", before scale and offset
};

enum class TextEncoding : std::uint8_t {
    utf8, ///< also any other in which ASCII is itself; UTF-16 is known by its byte order mark
    utf16le,
};

/// One file of a foreign log.
struct TableMapping {
    std::string file; ///< its name; '*' stands for what it shares with the other files of the trip
    char separator = ',';
    char decimal = '.';
    TextEncoding encoding = TextEncoding::utf8;
    std::size_t skip_lines = 0;
    std::string comment;                 ///< lines that begin so are left out; "": none
    std::string header_begins;           ///< everything before such a line is left out; "": nothing
    bool has_header = true;              ///< a row of column names
    std::size_t rows_under_header = 0;   ///< units and the like, no data
    std::vector<std::string> empty;      ///< words that mean an empty cell
    std::array<int, 3> axes = {1, 2, 3}; ///< axis i of the trip is the table's axes[i], 1 to 3; a
                                         ///< negative one is turned about
    bool is_gravity = false;             ///< to be added to the acceleration of the other files
    TimeMapping time;
    std::vector<ChannelMapping> channels;
};

/// A logger's clock that was stopped now and then: from such a reading on it is so much late.
struct ClockPiece {
    double from_s;
    double late_s;
};

/// How a foreign log becomes a trip.
struct TripMapping {
    std::string where;                      ///< for messages: the mapping's file, or the export
    std::vector<TableMapping> tables;       ///< at least one; the first names the trip
    TripMeta meta;                          ///< what the log itself does not say
    std::vector<ClockPiece> clock;          ///< in the order of time
    std::optional<double> clock_zero_utc_s; ///< what the clock's 0 is, where it is known
};

} // namespace macadam
