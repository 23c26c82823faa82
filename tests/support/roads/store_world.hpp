#pragma once

#include "storage/store/road_store.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace macadam::testing {

// A small country for the store: three roads of a few hundred metres near Lyon.
//
//     A---------B---------C      way 1 "Rue de l'Épée 100%", both ways
//               |
//     D---------E                way 2 B-E, oneway towards E; way 3 E-D without a name
RoadNetwork small_country();

StoreSettings settings();

/// A new store of it in the running test's folder.
RoadStore new_store(const std::filesystem::path& file);

/// A trip of car "car-N" named and hashed after `number`.
TripRecord trip_record(int number);

/// What that trip says of every segment of way 1 in both directions: the numbers come from
/// `number` alone.
std::vector<Pass> passes_of(int number);

/// Imports trips 0 to `count` - 1 and fuses them.
void import_trips(RoadStore& store, int count);

} // namespace macadam::testing
