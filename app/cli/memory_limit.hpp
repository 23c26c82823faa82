#pragma once

#include <string_view>

namespace macadam {

/// Prepares the process for a limited address space (`ulimit -v`), if it has one. The allocator
/// becomes sparing with addresses, and the crash of a library for lack of memory (SIGSEGV, SIGBUS,
/// SIGABRT) removes unfinished files and ends the program with a message and exit status 1.
/// Macadam's own code throws std::bad_alloc. Call before any thread starts.
///
/// \param command  name of the command in the message
void bear_memory_limit(std::string_view command);

} // namespace macadam
