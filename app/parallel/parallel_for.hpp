#pragma once

#include "estimator/common/progress.hpp"

#include <cstddef>
#include <functional>

namespace macadam {

/// Calls work(0) to work(count - 1), each once, on `jobs` threads and reports progress from any of
/// them, one at a time. The first exception stops the remaining calls and is rethrown. After a stop
/// request no further calls begin.
void parallel_for(std::size_t count,
                  std::size_t jobs,
                  const std::function<void(std::size_t)>& work,
                  const Progress& progress = {});

} // namespace macadam
