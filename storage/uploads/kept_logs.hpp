#pragma once

#include "storage/sqlite/sqlite.hpp"
#include "storage/uploads/upload_queue.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

// Logs that a server keeps after they were imported, if `init --keep-logs` says so: encrypted, for
// a stated time, to be reprocessed by who has the secret key. They lie in the folder `kept/` of the
// uploads and go with their trips.

/// Encrypts the log of an upload and keeps it; the log itself stays in the spool.
/// \param public_key  64 hex digits (storage/uploads/sealed_log.hpp)
/// \throws InputError  if it cannot be written.
void keep_log(const std::filesystem::path& store,
              const Upload& upload,
              std::string_view public_key);

/// Log that is kept.
struct KeptLog {
    std::filesystem::path file;
    std::string name; ///< of the log: its SHA-256 and suffix
};

/// All of them, in the order of their names.
std::vector<KeptLog> kept_logs(const std::filesystem::path& store);

/// Erases the kept log of an upload, if there is one.
void erase_kept_log(const std::filesystem::path& store, const Upload& upload);

/// Erases logs whose time is over, of which a trip is not in the road database any longer, or whose
/// upload is deleted.
/// \param received_before_ms  time until which a log must have come to be erased, ms since 1970 UTC
/// \param is_stored           tests for a trip of the road database by its hash
void erase_old_logs(Database& uploads,
                    const std::filesystem::path& store,
                    std::int64_t received_before_ms,
                    const std::function<bool(const std::string& sha256)>& is_stored);

} // namespace macadam
