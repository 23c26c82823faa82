#pragma once

#include "estimator/common/progress.hpp"
#include "storage/sqlite/lock_wait_policy.hpp"
#include "storage/store/connection/store_connection.hpp"
#include "storage/store/records/maintenance_records.hpp"

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

/// Opens a database on a server to forget trips, and for nothing else: the private copy holds only
/// the chunks that they drove and what else forgetting them changes; all of it if they calibrated
/// cars. Otherwise as open_server_replica(), but without comparing digests of the whole.
///
/// \param request  that StoreMaintenance::forget() is called with.
std::shared_ptr<StoreConnection> open_replica_to_forget(const std::string& address,
                                                        const ForgetRequest& request,
                                                        const LockWaitPolicy& wait_policy,
                                                        const Progress& progress);

/// Opens a database on a server for its next publication, and for nothing else: the private copy
/// holds only the chunks that were driven since earlier ones, with all passes of who drove there,
/// and not all roads; the whole database for the first one. Otherwise as open_server_replica(), but
/// without comparing digests of the whole.
std::shared_ptr<StoreConnection> open_replica_to_publish(const std::string& address,
                                                         const LockWaitPolicy& wait_policy,
                                                         const Progress& progress);

} // namespace macadam
