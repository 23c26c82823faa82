#pragma once

#include <functional>
#include <stop_token>

namespace macadam {

/// Calls `work` on a thread of its own, without the lock of the interpreter, while the calling
/// thread answers Python's signals: Ctrl-C requests a stop and becomes KeyboardInterrupt when
/// `work` has returned.
///
/// \throws  what `work` throws, unless a signal handler raised an exception.
void run_interruptibly(const std::function<void(const std::stop_token&)>& work);

} // namespace macadam
