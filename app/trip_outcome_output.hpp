#pragma once

#include "app/import_trips.hpp"

namespace macadam {

/// Tells what became of a trip on standard output at once: as a line of JSON, or in words.
void tell_of(const TripOutcome& outcome, bool json);

} // namespace macadam
