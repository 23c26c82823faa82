#pragma once

#include "estimator/common/progress.hpp"
#include "storage/postgres/server_connection.hpp"
#include "storage/sqlite/lock_wait_policy.hpp"
#include "storage/store/server/copy/new_copy.hpp"

#include <filesystem>

namespace macadam {

// Copies of databases on servers that are kept for their next reader: files in
// $XDG_CACHE_HOME/macadam/copies/ of mode 0600. A copy follows new trips and fusion by what changed
// in between; after anything else, and on another timeline of the server, it is made anew. One of
// publications is made anew with each of them.

/// Brings the copy of a database up to date, or makes it. Processes of one user take turns.
///
/// \returns its file, and beside it the key if this user has it and it holds more than
/// publications. \throws InputError  if there is no home folder, or the server fails; then the copy
/// stays as it
///                     was.
std::filesystem::path refreshed_mirror(ServerConnection& server,
                                       ServerContent content,
                                       const LockWaitPolicy& wait_policy,
                                       const Progress& progress);

/// Removes all copies of a database but publications, after trips were forgotten or the like.
/// Programs that have one open read on.
void remove_mirrors_of_fusion(ServerConnection& server);

} // namespace macadam
