#pragma once

#include "estimator/common/progress.hpp"
#include "storage/postgres/server_connection.hpp"
#include "storage/sqlite/lock_wait_policy.hpp"
#include "storage/store/connection/store_connection.hpp"
#include "storage/store/copy/file_copy.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/server/copy/rows_from_server.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace macadam {

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

/// The key of a copy of a database on a server, if this user has it.
std::optional<PrivacyKey> key_of_copy(Database& copy);

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
