#pragma once

#include "app/cli/console.hpp"
#include "storage/store/road_store.hpp"

namespace macadam {

/// Says so if others than its owner can read the key that lies beside the store.
void warn_of_open_key(const RoadStore& store, const Console& console);

/// Before cars are named: makes a key if none lies there, and says what it cannot do.
void make_missing_key(RoadStore& store, const Console& console);

} // namespace macadam
