#pragma once

#include "app/cli/arguments.hpp"

#include <memory>

namespace macadam {

struct TripMapping;

/// For the tables of the commands that read trips.
inline constexpr Option mapping_option{
    "--mapping",
    "NAME|FILE",
    "Column mapping for files of another logger: racechrono, trackaddict or a TOML file."};

/// The mapping that --mapping names; null without it.
///
/// \throws UsageError  for a name that is neither built in nor a file. \throws InputError for a
/// file
///                     that is no mapping.
std::shared_ptr<const TripMapping> mapping_of(const Arguments& arguments);

} // namespace macadam
