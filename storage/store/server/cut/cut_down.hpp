#pragma once

#include "estimator/common/progress.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <span>
#include <string>

namespace macadam {

/// Removes from a copy what does not belong to some chunks: other passes and values, trips and cars
/// that drove elsewhere, and roads. Left are the ways of the chunks, and those that meet them,
/// which decide where these are cut into segments; segments of the latter are numbered anew, as
/// roads beyond them are missing. The removed bytes leave the file.
///
/// \param file      opened with Access::create; holds all passes and values of the chunks, all
///                  segments of their ways, and the ways that meet these
/// \param chunks    rows of their first segments, with values of the source
/// \param cut_from  for the audit
/// \throws InputError  if segments are not those of their ways, or a stop is requested.
void cut_down(Database& file,
              std::span<const std::int64_t> chunks,
              const std::string& cut_from,
              const Progress& progress);

} // namespace macadam
