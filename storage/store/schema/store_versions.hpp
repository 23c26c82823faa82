#pragma once

#include "storage/store/schema/schema_check.hpp"

namespace macadam {

/// Objects that a database of an earlier version may hold: those of today, but in the words of
/// then. Those that came later are not there yet.
Schema schema_of_version(int version);

} // namespace macadam
