#pragma once

#include "app/cli/console.hpp"
#include "app/import/import_trips.hpp"

namespace macadam {

/// Prints the report of a trip on standard output at once, as a line of JSON or as text. In text, a
/// quiet console is told only rejected trips, and warnings on standard error.
void print_report(const TripReport& trip, bool json, const Console& console);

} // namespace macadam
