#pragma once

#include "estimator/common/trip.hpp"
#include "storage/trips/log/trip_row.hpp"
#include "storage/trips/mappings/dbc.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Column of a foreign table: by name, in which '*' stands for any characters and case is ignored,
/// or by number from 1, where names are missing or not unique.
struct ColumnName {
    std::string pattern;
    std::size_t number = 0; ///< 0: by name
};

enum class TimeFormat : std::uint8_t {
    number,         ///< a number in units of `unit_s`
    clock,          ///< hh:mm:ss, with or without a fraction
    compact_clock,  ///< hhmmss as one number
    day_month_year, ///< dd/mm/yyyy hh:mm:ss, with any separators; months may be names
    month_day_year,
    year_month_day, ///< ISO 8601, with T or a blank, with or without a time zone
};

/// Time columns of a table.
struct TimeMapping {
    std::vector<ColumnName> columns; ///< joined by a blank: date and time may be separate columns
    TimeFormat format = TimeFormat::number;
    double unit_s = 1;
    bool since_1970 = false;            ///< numbers count from 1970-01-01T00:00:00Z
    std::optional<double> utc_offset_s; ///< local time minus UTC, for text without a time zone
    /// Unit of the digits after the seconds; `std::nullopt`: decimals.
    std::optional<double> fraction_s;
    double shift_s = 0; ///< added to times, to correct a known clock error
};

/// Column of a channel: value = scale * cell + offset.
struct ChannelMapping {
    TripColumn channel;
    ColumnName column; ///< or the name of a signal, where the file is no table
    double scale = 1;  ///< includes unit and sign
    double offset = 0;
    std::vector<double> invalid{}; ///< cell values that mean "none", before scale and offset
    bool degrees_minutes = false;  ///< cells are ddmm.mmmm, as in NMEA 0183
    std::optional<ColumnName> hemisphere{}; ///< column of N, S, E or W; S and W negate
    bool unit_stated = true;                ///< otherwise that of the signal, if it states one
    DbcChoice in_dbc{};                     ///< signal of a CAN log
    std::string times{};                    ///< HDF5: dataset with its times
};

/// Format of a foreign log.
enum class LogFormat : std::uint8_t {
    table, ///< CSV
    can,   ///< candump or Vector ASC, with a DBC
    mdf,   ///< ASAM MDF 4
    hdf5,
};

enum class TextEncoding : std::uint8_t {
    utf8, ///< or any superset of ASCII; UTF-16 is recognised by its byte order mark
    utf16le,
    latin1, ///< ISO 8859-1
};

/// File of a foreign log.
struct TableMapping {
    LogFormat format = LogFormat::table;
    std::shared_ptr<const Dbc> dbc{}; ///< of a CAN log
    std::string dbc_name{};           ///< its file, for messages
    std::string bus{};                ///< "can0": frames of others are not read; "": all
    std::string file; ///< its name; '*' stands for the part shared by all files of the trip
    char separator = ',';
    char decimal = '.';
    TextEncoding encoding = TextEncoding::utf8;
    std::size_t skip_lines = 0;
    std::string comment; ///< prefix of lines to skip; "": none
    /// Lines before the first one with this prefix are skipped; "": none.
    std::string header_begins;
    bool has_header = true;            ///< whether there is a row of column names
    std::size_t rows_under_header = 0; ///< rows of units and the like to skip
    std::vector<std::string> empty;    ///< words that mean an empty cell
    /// Axis i of the trip is the table's axes[i], 1 to 3; negative: reversed.
    std::array<int, 3> axes = {1, 2, 3};
    bool is_gravity = false; ///< added to the acceleration of the other files
    TimeMapping time;
    std::vector<ChannelMapping> channels;
};

/// Offset of a logger's clock that was paused: from this reading on, it is late by this much.
struct ClockPiece {
    double from_s;
    double late_s;
};

/// Mapping of a foreign log to a trip.
struct TripMapping {
    std::string where;                      ///< for messages: file of the mapping, or the export
    std::vector<TableMapping> tables;       ///< at least one; the first names the trip
    TripMeta meta;                          ///< defaults for what the log does not state
    std::vector<ClockPiece> clock;          ///< in the order of time
    std::optional<double> clock_zero_utc_s; ///< UTC of the clock's zero, if known
};

} // namespace macadam
