#pragma once

#include "mapping/background/background.hpp"
#include "storage/sqlite/lock_wait_policy.hpp"
#include "storage/store/background/background_rows.hpp"

#include <filesystem>

namespace macadam {

/// Replaces the background of a road database, in one transaction. It belongs to no generation and
/// is no part of the digest.
///
/// \param box     background_box() of its roads
/// \param source  null: the background is removed
/// \throws InputError  if it is not a road database.
BackgroundSize put_background(const std::filesystem::path& store,
                              const GeoBox& box,
                              const BackgroundSource& source,
                              LockWaitPolicy wait_policy = {});

} // namespace macadam
