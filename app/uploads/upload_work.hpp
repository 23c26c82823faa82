#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "app/import/import_trips.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Parses options of `import`, by which uploads are worked out.
/// \throws UsageError  for invalid ones.
Arguments upload_arguments(std::vector<std::string> words);

/// Settings by which uploads are imported.
struct UploadWork {
    std::filesystem::path store;
    Arguments arguments; ///< upload_arguments()
    /// Start of a program that may be killed and started again: then a log at which it ended twice
    /// waits for 10 s, and each time for 10 s more.
    std::optional<std::chrono::steady_clock::time_point> running_since{};
    /// Receives the report of each trip.
    std::function<void(const TripReport&)> tell{};
};

/// Works out what waits in the queue of uploads: forgets the trips of one that is to be deleted, or
/// imports a batch of logs as `macadam import` does. Each log leaves the spool once its trips are
/// in the database. A kill at any moment loses no log and imports none twice; a log at which the
/// program ended 50 times is refused.
///
/// \param uploads  open_uploads() of the database
/// \returns whether there was anything to do.
/// \throws InputError  if the database cannot be written, or a stop is requested; what was not done
///                     waits on.
bool work_out_uploads(Database& uploads, const UploadWork& work, const Console& console);

/// Works out all that waits, or waits for the workers of a server to do so: before trips are
/// forgotten, so that none comes in later. Does nothing for a database without a server.
/// \throws InputError  if a stop is requested.
void work_out_all_uploads(const std::filesystem::path& store, const Console& console);

/// Erases kept logs of trips that the database no longer has, and forgets who sent trips that the
/// database no longer has.
void drop_forgotten_uploads(const StoreReader& store, const Console& console);

} // namespace macadam
