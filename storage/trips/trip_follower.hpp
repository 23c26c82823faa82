#pragma once

#include "storage/trips/log/trip_assembly.hpp"
#include "storage/trips/log/trip_rows.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// A "macadam-trip 1" log while it is being written: its samples row by row, as soon as each line
/// is whole. Nothing is kept of what was handed on.
class TripFollower {
public:
    /// Reads the head, and waits for it.
    ///
    /// \param file  plain, .gz or .zst; "-": standard input.
    ///
    /// \throws InputError  "file:line: ..." if it is no such log or lacks a needed column.
    TripFollower(const std::filesystem::path& file, const TripNeeds& needs);

    const TripMeta& meta() const { return rows_.meta(); }
    const std::vector<std::string>& unknown_columns() const { return rows_.header().unknown; }

    /// What the next row gave; `rows` has one entry, which says why if it gave nothing. Nothing at
    /// the end.
    ///
    /// \throws InputError  if "# end rows: N" comes with a wrong N.
    std::optional<TripLog> next();

    /// Whether "# end rows: N" has come, by which a log says that it is whole.
    bool closed() const { return rows_.closed(); }
    std::size_t count() const { return rows_.count(); }

    const std::string& name() const { return name_; }   ///< of the file, for messages
    std::string where() const { return rows_.where(); } ///< "file:line" of the row that came last
    std::string row_text() const;                       ///< "file:line: 'text'" of it

private:
    std::string name_;
    TripRows rows_;
    TripStreams streams_;
};

} // namespace macadam
