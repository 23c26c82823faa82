#pragma once

#include "estimator/common/progress.hpp"

#include <cstddef>
#include <functional>

namespace macadam {

/// Calls work(0) to work(count - 1), each once, by `jobs` threads; tells progress from any of them,
/// one at a time. What a call throws stops the rest and is thrown on. When a stop is requested the
/// calls that were not begun are left out.
void parallel_for(std::size_t count,
                  std::size_t jobs,
                  const std::function<void(std::size_t)>& work,
                  const Progress& progress = {});

} // namespace macadam
