#pragma once

#include "app/console.hpp"
#include "storage/lock_wait.hpp"

#include <filesystem>
#include <stop_token>

namespace macadam {

/// How a command waits while another one writes the store: it says once for whom, and `stop` ends
/// the wait. Without a stop, Ctrl-C ends the program.
LockPatience
patience_for(const std::filesystem::path& store, const Console& console, std::stop_token stop = {});

} // namespace macadam
