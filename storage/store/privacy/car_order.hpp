#pragma once

#include "storage/sqlite/sqlite.hpp"

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace macadam {

/// Pseudonyms of the cars of a database, in the order of StoreUsage::cars. Pseudonyms depend on
/// the key, the order does not.
std::vector<std::string> read_cars(Database& database);

/// Index of each car in this order, from 0.
std::map<std::string, std::size_t> places_of_cars(std::span<const std::string> cars);

} // namespace macadam
