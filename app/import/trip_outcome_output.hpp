#pragma once

#include "app/import/import_trips.hpp"

namespace macadam {

/// Tells what became of a trip on standard output at once: as a line of JSON, or in words.
void print_outcome(const TripOutcome& outcome, bool json);

} // namespace macadam
