#pragma once

#include "estimator/common/progress.hpp"
#include "storage/atomic/atomic_file_set.hpp"
#include "storage/postgres/server_connection.hpp"
#include "storage/sqlite/lock_wait_policy.hpp"
#include "storage/store/connection/store_connection.hpp"
#include "storage/store/server/copy/rows_from_server.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace macadam {

/// Result of copying a database between engines.
struct StoreCopy {
    std::size_t trips = 0;
    std::size_t passes = 0;
    std::string digest;             ///< equal on both sides; of a part, of its chunks
    bool by_superuser = false;      ///< of the server
    bool is_activity_open = false;  ///< of a crowd on a server, see reader_rights.hpp
    std::filesystem::path key_file; ///< where the key of the copy is, if it is at hand
};

/// Copies a database from a file to a server, in one transaction: all of it or, on failure,
/// nothing. Its key, if it lies beside the file, is kept at server_key_file().
///
/// \throws InputError  if the server already has one.
StoreCopy copy_to_server(const std::filesystem::path& file,
                         const std::string& address,
                         const LockWaitPolicy& wait_policy,
                         const Progress& progress);

/// Copies the moment of a database on a server to a new file. Its key is put beside it if this user
/// has it; it is not on the server.
///
/// \throws InputError  if the file exists.
StoreCopy copy_from_server(const std::string& address,
                           const std::filesystem::path& file,
                           const Progress& progress);

/// \throws InputError  if a file of this name exists.
void expect_new_file(const std::filesystem::path& file);

/// Ends a copy of a database on a server, or of a part of it: compares its digest with that on the
/// server, ends the transaction there, puts the file in place and its key beside it.
///
/// \param database  the new file, with the name of its place for messages
/// \throws InputError  if the digests differ.
StoreCopy finish_copy(ServerConnection& server,
                      Database& database,
                      AtomicFileSet& whole,
                      const std::string& original,
                      const Progress& progress);

/// Copies roads and settings alone to a new file, a database without trips. Within the caller's
/// transaction.
///
/// \throws InputError  if the file exists.
void copy_network_from_server(ServerConnection& server,
                              const std::filesystem::path& file,
                              const Progress& progress);

/// Tells a connection to a copy of a database on a server where its key belongs: at
/// server_key_file(), and never made anew.
void know_server_key_file(StoreConnection& copy);

/// Opens a private copy of the moment of a database in the folder of temporary files, with its key
/// if this user has it. The copy is removed with the last user of the connection.
///
/// \param fill  fills the new file, with all of the database or a part (new_copy.hpp).
std::shared_ptr<StoreConnection>
open_server_copy(ServerConnection& server,
                 Database::Access access,
                 const LockWaitPolicy& wait_policy,
                 const Progress& progress,
                 const std::function<void(RowsFromServer& rows, Database& file)>& fill);

} // namespace macadam
