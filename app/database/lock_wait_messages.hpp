#pragma once

#include "app/cli/console.hpp"
#include "storage/sqlite/lock_wait_policy.hpp"
#include "storage/store/road_store.hpp"

#include <filesystem>

namespace macadam {

/// Returns the wait policy of a command while another one writes to the database: it names the
/// other process once, and Ctrl-C ends the wait.
LockWaitPolicy wait_policy_for(const std::filesystem::path& store, const Console& console);

/// Opens a database for a command that writes, with that wait policy.
RoadStore opened_store(const std::filesystem::path& file, const Console& console);

/// Opens a database for a command that reads, with that wait policy.
StoreReader opened_reader(const std::filesystem::path& file,
                          const Console& console,
                          Audience audience = Audience::anyone);

} // namespace macadam
