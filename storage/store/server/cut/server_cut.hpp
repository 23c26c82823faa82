#pragma once

#include "estimator/common/progress.hpp"
#include "storage/store/copy/region_cut.hpp"

#include <filesystem>
#include <string>

namespace macadam {

/// Cuts a region of a database on a server out into a new file, as cut_from_file(), from a part
/// that is fetched into a temporary file beside it. The key as copy_from_server().
///
/// \throws InputError  if the file exists, or no road lies in the region.
StoreCopy cut_from_server(const std::string& address,
                          const Region& region,
                          const std::filesystem::path& file,
                          const Progress& progress);

} // namespace macadam
