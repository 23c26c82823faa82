#pragma once

#include "app/cli/console.hpp"

#include <string>

namespace macadam {

/// Erases submitted logs with trips that were permanently deleted from a database on a server, and
/// takes them out of its queue. If the object store cannot be reached, warns: the next worker
/// erases them.
void erase_forgotten_logs(const std::string& address, const Console& console);

} // namespace macadam
