#pragma once

#include "mapping/background/background.hpp"
#include "storage/sqlite/lock_wait_policy.hpp"
#include "storage/store/background/background_rows.hpp"

#include <filesystem>
#include <string>

namespace macadam {

/// Replaces the background of a road database, in one transaction. It belongs to no generation and
/// is no part of the digest.
///
/// \param box     background_box() of its roads
/// \param source  null: the background is removed
/// \param detail  of the entry in the audit; "": none, in a new database
/// \throws InputError  if it is not a road database.
BackgroundSize put_background(const std::filesystem::path& store,
                              const GeoBox& box,
                              const BackgroundSource& source,
                              const std::string& detail = {},
                              LockWaitPolicy wait_policy = {});

} // namespace macadam
