#pragma once

#include "storage/store/road_store.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

namespace macadam::testing {

/// An import as the program does it: notes that it begins, adds the trips, fuses, and takes the
/// note away. `acknowledged` is called with the number of each trip that is in the store when it
/// is, new or known.
void import_into(RoadStore& store, int trips, const std::function<void(int)>& acknowledged = {});

/// The same from opening the store to closing it.
void import_into(const std::filesystem::path& store, int trips);

/// The digest of a store with those trips that nothing disturbed, beginning as `empty`.
std::string undisturbed_digest(const std::filesystem::path& empty, int trips);

/// What SQLite itself finds wrong in a store, "ok" if nothing; undoes what was cut off.
std::string damage_of(const std::filesystem::path& store);

/// As many as usual, or those that MACADAM_TEST_ALL asks for.
std::size_t tries(std::size_t usual, std::size_t all);

} // namespace macadam::testing
