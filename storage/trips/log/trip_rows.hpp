#pragma once

#include "storage/tables/text_lines.hpp"
#include "storage/trips/log/trip_row.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace macadam {

/// Reads the data rows of a "macadam-trip 1" log as its bytes arrive: each row is available before
/// the next one is written.
class TripRows {
public:
    /// Reads up to the header row.
    ///
    /// \throws InputError  "file:line: ..." if it is not such a log or lacks a required column.
    TripRows(std::unique_ptr<ByteStream> bytes, const TripSource& source, const TripNeeds& needs);

    const TripMeta& meta() const { return meta_; }
    const TripHeader& header() const { return header_; }

    /// Next row; `std::nullopt` at the end, with or without "# end rows: N".
    ///
    /// \throws InputError  if N is not the number of rows, or that line is not the last.
    std::optional<TripRow> next();

    bool closed() const { return closed_; } ///< "# end rows: N" was read
    std::size_t count() const { return count_; }

    /// Text of the last row; valid until the next call of next().
    std::string_view line() const { return line_; }
    std::string where() const { return lines_.where(); } ///< "file:line" of the last row

private:
    void expect_end();

    TextLines lines_;
    TripMeta meta_;
    TripHeader header_;
    std::string_view line_;
    std::size_t count_ = 0;
    bool closed_ = false;
};

/// \throws InputError  always: the log ends without "# end rows: N".
[[noreturn]] void refuse_unclosed(const TripRows& rows);

} // namespace macadam
