#pragma once

#include "storage/tables/text_lines.hpp"
#include "storage/trips/log/trip_row.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace macadam {

/// The data rows of a "macadam-trip 1" log, one after the other, as its bytes come: no row waits
/// for the next one.
class TripRows {
public:
    /// Reads the head, up to the header row.
    ///
    /// \throws InputError  "file:line: ..." if it is no such log or lacks a needed column.
    TripRows(std::unique_ptr<ByteStream> bytes, const TripSource& source, const TripNeeds& needs);

    const TripMeta& meta() const { return meta_; }
    const TripHeader& header() const { return header_; }

    /// Nothing at the end, whether "# end rows: N" stands there or the bytes just end.
    ///
    /// \throws InputError  if N is not the number of rows, or something follows that line.
    std::optional<TripRow> next();

    bool closed() const { return closed_; } ///< "# end rows: N" has come
    std::size_t count() const { return count_; }

    /// The row that came last; good until the next call of next().
    std::string_view line() const { return line_; }
    std::string where() const { return lines_.where(); } ///< "file:line" of it

    std::uint64_t consumed() const { return lines_.consumed(); }
    std::string sha256() { return lines_.sha256(); }

private:
    void expect_end();

    TextLines lines_;
    TripMeta meta_;
    TripHeader header_;
    std::string_view line_;
    std::size_t count_ = 0;
    bool closed_ = false;
};

/// \throws InputError  that the log ends without "# end rows: N".
[[noreturn]] void refuse_unclosed(const TripRows& rows);

} // namespace macadam
