#pragma once

#include "storage/trips/signals/signal_rows.hpp"

#include <string>
#include <string_view>

namespace macadam {

/// Reads the channels of an ASAM MDF 4 file that a mapping names: "CHANNEL", or "GROUP.CHANNEL"
/// where several groups have one. Each record of their channel groups is a row.
///
/// Read are sorted and unsorted data groups, deflated (also transposed) data, lists of blocks,
/// integers and floats of both byte orders, linear and rational conversions, invalidation bits, and
/// master channels that state the time, also virtual ones. Records of variable length (VLSD) are
/// skipped.
///
/// \param bytes  the whole file
/// \throws InputError  "file: ..." if it is damaged or truncated, lacks a channel, or if a channel
///                     or its conversion is of another kind.
SignalRows read_mdf(std::string_view bytes, const TableMapping& mapping, const std::string& name);

/// Names of the channels of a file, "GROUP.CHANNEL" with their units, for people.
std::vector<std::string> mdf_channels(std::string_view bytes, const std::string& name);

} // namespace macadam
