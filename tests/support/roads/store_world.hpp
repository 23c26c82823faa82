#pragma once

#include "storage/store/road_store.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace macadam::testing {

// Small country for database tests: three roads of a few hundred metres near Lyon.
//
//     A---------B---------C      way 1 "Rue de l'Épée 100%", both ways
//               |
//     D---------E                way 2 B-E, oneway towards E; way 3 E-D without a name
RoadNetwork small_country();

StoreSettings settings();

/// Creates a database of it in the running test's folder.
RoadStore new_store(const std::filesystem::path& file);

/// Returns a trip of car "car-N", with name and hash from `number`.
TripRecord trip_record(int number);

/// Returns the passes of that trip over every segment of way 1 in both directions. The values
/// depend on `number` alone.
std::vector<Pass> passes_of(int number);

/// Adds one trip. \returns whether it is new.
bool add_trip(RoadStore& store,
              const TripRecord& trip,
              std::span<const Pass> passes,
              std::span<const RoughnessTrace> traces = {},
              const std::optional<std::span<const PassEvent>>& events = {});

/// Stages new results of one trip. \returns false if the store has no such trip.
bool stage_trip(RoadStore& store,
                const TripRecord& trip,
                std::span<const Pass> passes,
                std::span<const RoughnessTrace> traces,
                const std::optional<std::span<const PassEvent>>& events = {});

/// Imports trips 0 to `count` - 1 and fuses them.
void import_trips(RoadStore& store, int count);

/// Imports and fuses trips 4 to 6, which a crowd database keeps whole: their recorder left out
/// enough at their ends. Each reports one pothole.
void import_trimmed_trips(RoadStore& store);

} // namespace macadam::testing
