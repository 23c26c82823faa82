#pragma once

#include "app/cli/console.hpp"

#include <string>

namespace macadam {

/// Permanently deletes the trips of logs whose senders deleted them, as `forget` does, and ends
/// their jobs. Importers wait meanwhile.
/// \throws InputError  if that fails; what was not deleted is so by the next call.
void delete_trips_of_logs(const std::string& address, const Console& console);

} // namespace macadam
