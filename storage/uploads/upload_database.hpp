#pragma once

#include "storage/sqlite/lock_wait_policy.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <filesystem>
#include <string_view>

namespace macadam {

/// Folder NAME.gpkg.uploads beside a road database: what its server needs to take trips. It holds
/// access tokens and the fate of each upload in `uploads.db`, and logs that wait in `spool/`; only
/// its owner can enter it (0700). A folder, and no table of the database, because
///  - copies and exports of the database then hand on neither tokens nor logs,
///  - an upload and a revoked token never wait for a transaction of an import, which may be long.
std::filesystem::path uploads_folder_of(const std::filesystem::path& store);

std::filesystem::path spool_of(const std::filesystem::path& store);

/// Tests whether the folder was made.
bool takes_uploads(const std::filesystem::path& store);

/// Makes the folder if it is missing.
/// \throws InputError  if it cannot be made.
void make_uploads_folder(const std::filesystem::path& store);

/// Opens `uploads.db`; each commit is on disk when it returns, and readers never wait.
/// \throws InputError  if it is missing or no such database.
Database open_uploads(const std::filesystem::path& store, LockWaitPolicy wait_policy = {});

} // namespace macadam
