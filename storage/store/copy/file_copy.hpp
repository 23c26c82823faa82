#pragma once

#include "estimator/common/progress.hpp"
#include "storage/atomic/atomic_file_set.hpp"
#include "storage/sqlite/lock_wait_policy.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/connection/store_connection.hpp"
#include "storage/store/privacy/privacy_key.hpp"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace macadam {

/// Result of copying a database, or a part of it.
struct StoreCopy {
    std::size_t trips = 0;
    std::size_t passes = 0;
    std::string digest;             ///< equal on both sides; of a part, of its chunks
    bool by_superuser = false;      ///< of the server
    bool is_activity_open = false;  ///< of a crowd on a server, see reader_rights.hpp
    std::filesystem::path key_file; ///< where the key of the copy is, if it is at hand
};

/// Opens a database that is to be copied.
///
/// \throws InputError  if it is a crowd's without its key, and thus hides its trips.
std::shared_ptr<StoreConnection> open_original(const std::filesystem::path& file,
                                               const LockWaitPolicy& wait_policy);

/// \throws InputError  if a file of this name exists.
void expect_new_file(const std::filesystem::path& file);

/// \throws InputError  if the digest of a copy is not that of its original.
void expect_same_digest(const std::string& copied,
                        const std::string& original,
                        const std::string& copy);

/// Ends a copy in a new file: compares digests, puts the file in place and the key beside it.
///
/// \param database  the new file, with the name of its place for messages
/// \param original  digest of what was copied
/// \throws InputError  if the digests differ.
StoreCopy finish_copy(Database& database,
                      AtomicFileSet& whole,
                      const std::string& original,
                      const std::optional<PrivacyKey>& key,
                      const Progress& progress);

} // namespace macadam
