#pragma once

#include "app/import/import_trips.hpp"

namespace macadam {

/// Prints the outcome of a trip on standard output at once, as a line of JSON or as text.
void print_outcome(const TripOutcome& outcome, bool json);

} // namespace macadam
