#pragma once

#include "storage/trips/log/trip_assembly.hpp"
#include "storage/trips/log/trip_rows.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Follows a "macadam-trip 1" log while it is being written, and returns its samples row by row as
/// soon as a line is complete. Returned rows are not kept.
class TripFollower {
public:
    /// Waits for the header and reads it.
    ///
    /// \param file  plain, .gz or .zst; "-": standard input.
    ///
    /// \throws InputError  "file:line: ..." if it is not such a log or lacks a required column.
    TripFollower(const std::filesystem::path& file, const TripNeeds& needs);

    const TripMeta& meta() const { return rows_.meta(); }
    const std::vector<std::string>& unknown_columns() const { return rows_.header().unknown; }

    /// Samples of the next row; `rows` has one entry, with the reason if the row has no sample.
    /// `std::nullopt` at the end.
    ///
    /// \throws InputError  if "# end rows: N" has a wrong N.
    std::optional<TripLog> next();

    /// Tests whether "# end rows: N" was read, which marks a complete log.
    bool closed() const { return rows_.closed(); }
    std::size_t count() const { return rows_.count(); }

    const std::string& name() const { return name_; }   ///< file name for messages
    std::string where() const { return rows_.where(); } ///< "file:line" of the last row
    std::string row_text() const;                       ///< "file:line: 'text'" of the last row

private:
    std::string name_;
    TripRows rows_;
    TripStreams streams_;
};

} // namespace macadam
