#pragma once

#include "app/cli/console.hpp"

#include <string>

namespace macadam {

/// Waits until all logs that are in the queue of a database now are worked out, whatever comes
/// later. Workers that live do it, as they know the vehicle files; without one, this program.
///
/// \throws InputError  if none of these logs is worked out for twice the lease of the workers, if
///                     the object store cannot be reached, or a stop is requested.
void work_out_backlog(const std::string& address, const Console& console);

} // namespace macadam
