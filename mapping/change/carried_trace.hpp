#pragma once

#include "mapping/change/carried_pieces.hpp"

#include <optional>
#include <vector>

namespace macadam {

/// The trace of a drive over a new strip, from the metres of the old ones, with its margin before
/// and behind as far as they reach. Nothing where nothing is known.
std::optional<StripTrace>
trace_of(const CarriedDrive& drive, const std::vector<StripTrace>& old, double segment_length_m);

} // namespace macadam
