#pragma once

#include <string_view>

namespace macadam {

/// Where the address space of this process is limited (`ulimit -v`): makes the allocator spare of
/// it, and lets a library that crashes for lack of memory (SIGSEGV, SIGBUS, SIGABRT) end the
/// program with words and exit status 1 instead; what was begun is removed. Our own code throws
/// std::bad_alloc. To be called before any thread is started.
///
/// \param command  whose words these are
void bear_memory_limit(std::string_view command);

} // namespace macadam
