#pragma once

#include "app/cli/console.hpp"
#include "storage/sqlite/lock_wait.hpp"
#include "storage/store/road_store.hpp"

#include <filesystem>

namespace macadam {

/// How a command waits while another one writes the store: it says once for whom, and Ctrl-C ends
/// the wait.
LockWaitPolicy wait_policy_for(const std::filesystem::path& store, const Console& console);

/// Opens a store for a command, which waits so.
RoadStore opened_store(const std::filesystem::path& file,
                       RoadStore::Access access,
                       const Console& console,
                       Reader reader = Reader::anyone);

} // namespace macadam
