#pragma once

#include "app/arguments.hpp"

#include <memory>

namespace macadam {

struct TripMapping;

/// For the tables of the commands that read trips.
inline constexpr Option mapping_option{
    "--mapping",
    "NAME|FILE",
    "How the files of another logger become trips: racechrono, trackaddict, or a TOML file."};

/// The mapping that --mapping names; null without it.
///
/// \throws UsageError  for a name that is neither built in nor a file. \throws InputError for a
/// file
///                     that is no mapping.
std::shared_ptr<const TripMapping> mapping_of(const Arguments& arguments);

} // namespace macadam
