#pragma once

#include "storage/tables/text_lines.hpp"
#include "storage/trips/signals/signal_rows.hpp"

#include <string>

namespace macadam {

/// Reads the signals of a CAN log (can_frames.hpp) by the DBC of a mapping. Each line that is not
/// blank is a row: frames without a mapped signal and other lines are `unused_channel`, damaged
/// frames `bad_number`, frames too short for their signals `no_sample`.
///
/// \throws InputError  if no frame carries a mapped signal.
SignalRows read_can(TextLines lines, const TableMapping& mapping, const std::string& name);

} // namespace macadam
