#pragma once

#include "app/import/import_trips.hpp"
#include "storage/uploads/upload_state.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace macadam {

/// Result of importing one queued log, or archive of logs: what the import said of its trips.
struct LogOutcome {
    std::size_t imported = 0, known = 0, outside = 0, rejected = 0; ///< trips
    std::int64_t passes = 0;
    std::string reason{};              ///< the first one
    std::vector<std::string> stored{}; ///< SHA-256 of trips that are in the database
    std::vector<std::string> own{};    ///< of these, imported from this log

    std::size_t trips() const { return imported + known + outside + rejected; }
};

/// Tests whether a report is of a file, or of a member of an archive.
bool is_of(const TripReport& report, const std::filesystem::path& file);

/// Adds the report of a trip.
///
/// \param file        in which the log lay while it was imported: the program's own matter, which
///                    reasons do not name
/// \param is_our_own  whether a trip that is known was imported by an earlier attempt at this log,
///                    which a kill ended
void add(LogOutcome& outcome,
         const TripReport& report,
         const std::filesystem::path& file,
         bool is_our_own);

/// Fate of a log.
struct LogFate {
    UploadState state;
    std::string reason;
};
LogFate fate_of(const LogOutcome& outcome);

} // namespace macadam
