#pragma once

#include "app/cli/console.hpp"
#include "app/import/import_trips.hpp"
#include "app/import/trip_inputs.hpp"
#include "storage/atomic/temporary_folder.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/uploads/sealed_log.hpp"

#include <filesystem>

namespace macadam {

/// Erases logs that the server of a database keeps, if their time is over or they go with a trip
/// that is gone.
/// \param uploads  open_uploads() of the database
/// \throws InputError  if the database cannot be read.
void erase_old_logs_of(const std::filesystem::path& store,
                       Database& uploads,
                       const Console& console);

/// Logs that the server of a database keeps encrypted, as trips to be read. Each is opened in
/// memory, for as long as it is read.
class KeptTrips {
public:
    /// Erases old logs, and adds the others to `trips`, which must not outlive this object.
    /// \throws InputError  if there is no log, or `key_file` holds no key.
    KeptTrips(const std::filesystem::path& store,
              const std::filesystem::path& key_file,
              AskedTrips& trips,
              const Console& console);
    KeptTrips(const KeptTrips&) = delete;
    KeptTrips& operator=(const KeptTrips&) = delete;
    ~KeptTrips() = default;

    /// Report that names a log without the folder in which it was opened.
    TripReport named(TripReport report) const;

private:
    LogKey key_;
    TemporaryFolder folder_; ///< of links alone
};

} // namespace macadam
