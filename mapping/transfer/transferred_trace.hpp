#pragma once

#include "mapping/transfer/transferred_pieces.hpp"

#include <optional>
#include <vector>

namespace macadam {

/// The trace of a drive over a new chunk, from the metres of the old ones, with its margin before
/// and behind as far as they reach. Nothing where nothing is known.
std::optional<RoughnessTrace> trace_of(const CarriedDrive& drive,
                                       const std::vector<RoughnessTrace>& old,
                                       double segment_length_m);

} // namespace macadam
