#pragma once

#include "app/cli/arguments.hpp"

#include <memory>

namespace macadam {

struct TripMapping;

/// Option for commands that read trips.
inline constexpr Option mapping_option = in_group(
    "car and log",
    {"--mapping",
     "NAME|FILE",
     "Column mapping for files of another logger: racechrono, trackaddict or a TOML file."});

inline constexpr Option positions_option =
    in_group("car and log",
             {"--positions",
              "FILE",
              "Positions of the log as NMEA or GPX; otherwise a file of its name beside it, .nmea "
              "or .gpx."});

/// Returns the mapping of --mapping; null without it.
///
/// \throws UsageError  for a name that is neither built in nor a file.
/// \throws InputError  for a file that is no mapping.
std::shared_ptr<const TripMapping> mapping_of(const Arguments& arguments);

} // namespace macadam
