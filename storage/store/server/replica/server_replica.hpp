#pragma once

#include "estimator/common/progress.hpp"
#include "storage/sqlite/lock_wait_policy.hpp"
#include "storage/store/connection/store_connection.hpp"

#include <memory>
#include <string>

namespace macadam {

/// Opens a database on a server for work on all of it. It has the server alone until the connection
/// ends; importers and others wait.
///
/// The work is done on a private copy in the folder of temporary files, which is removed with the
/// last user of the connection. StoreConnection::written() brings what changed to the server, in
/// one transaction that ends with the digest of both being equal. Takes time and space in
/// proportion to the whole database.
///
/// \throws InputError  if the server cannot be reached, or the role may not write all of it.
std::shared_ptr<StoreConnection> open_server_replica(const std::string& address,
                                                     const LockWaitPolicy& wait_policy,
                                                     const Progress& progress);

} // namespace macadam
