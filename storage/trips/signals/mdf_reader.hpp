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

/// Channel with the identifier of a frame, in files of bus loggers.
inline constexpr std::string_view can_frame_id = "CAN_DataFrame.ID";

/// Reads the frames of a CAN bus in an MDF 4 file (ASAM bus logging: channel groups with
/// CAN_DataFrame), whose signals the DBC of a mapping describes. Each frame is a row; remote and
/// error frames are in other groups and are none. Their data may be of fixed, maximum (MLSD) or
/// variable length (VLSD, in a block or a group of its own).
///
/// Source: ASAM MDF, version 4.1.0 (2012), "Bus logging", chapter 4.
///
/// \throws InputError  as read_mdf, and if no frame carries a mapped signal.
SignalRows
read_mdf_frames(std::string_view bytes, const TableMapping& mapping, const std::string& name);

/// Names of the channels of a file, "GROUP.CHANNEL" with their units, for people.
std::vector<std::string> mdf_channels(std::string_view bytes, const std::string& name);

} // namespace macadam
