#pragma once

#include "app/import/import_trips.hpp"

namespace macadam {

/// Prints the report of a trip on standard output at once, as a line of JSON or as text.
void print_report(const TripReport& trip, bool json);

} // namespace macadam
