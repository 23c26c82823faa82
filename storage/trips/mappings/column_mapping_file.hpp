#pragma once

#include "storage/trips/mappings/column_mapping.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Reads the mapping of a logger's files to trips: a TOML file, or a built-in mapping by name.
/// docs/reference/other-loggers.md lists the keys.
///
/// \throws InputError  "file:line: ..." for an unknown or missing key, or an invalid value.
TripMapping read_mapping(const std::string& name_or_file);

/// Parses the text of a mapping; `name` stands for the file in messages.
///
/// \throws InputError  as read_mapping does.
TripMapping parse_mapping(std::string_view toml, const std::string& name);

/// Names of the built-in mappings: "racechrono" and the like.
std::vector<std::string_view> built_in_mapping_names();

} // namespace macadam
