#pragma once

#include "mapping/transfer/transferred_intervals.hpp"

#include <optional>
#include <vector>

namespace macadam {

/// Assembles the trace of a drive over a new chunk from the metres of the old traces, with its
/// margins as far as they reach. `std::nullopt` if no metre is known.
std::optional<RoughnessTrace> trace_of(const TransferredDrive& drive,
                                       const std::vector<RoughnessTrace>& old,
                                       double segment_length_m);

} // namespace macadam
