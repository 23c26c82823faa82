#pragma once

#include "app/cli/arguments.hpp"

#include <cstddef>

namespace macadam {

/// Value of --jobs in the help: the cores of this process (app/parallel/free_cores.hpp).
inline constexpr std::string_view default_jobs_words = "the free cores";

/// Parses --jobs; without it, returns default_jobs().
/// \throws UsageError  for an invalid number.
std::size_t jobs_of(const Arguments& arguments);

} // namespace macadam
