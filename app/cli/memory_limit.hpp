#pragma once

#include <string_view>

namespace macadam {

/// Prepares the process for a limited address space (`ulimit -v`), if it has one. The allocator
/// then uses few addresses, and a library that crashes for lack of memory (SIGSEGV,
/// SIGABRT) ends the program with a message and exit status 1, without unfinished files. Macadam's
/// own code throws std::bad_alloc. Call before any thread starts.
///
/// \param command  name of the command in the message
void bear_memory_limit(std::string_view command);

} // namespace macadam
