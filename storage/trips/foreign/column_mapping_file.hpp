#pragma once

#include "storage/trips/foreign/column_mapping.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Reads how the files of some logger become trips: a TOML file, or one of the built-in mappings by
/// its name. docs/reference/other-loggers.md lists the keys.
///
/// \throws InputError  "file:line: ..." for a key that is not known or lacks, or a value that does
///                     not fit.
TripMapping read_mapping(const std::string& name_or_file);

/// "racechrono" and the like.
std::vector<std::string_view> built_in_mapping_names();

} // namespace macadam
