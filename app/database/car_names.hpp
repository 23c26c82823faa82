#pragma once

#include "storage/store/reader/store_reader.hpp"

#include <string>
#include <vector>

namespace macadam {

/// Returns the pseudonym of a car, given by vehicle_id or pseudonym.
///
/// \throws InputError  for a crowd database, whose cars are never told apart, and for a car that
///                     the database does not know.
std::string car_named(const StoreReader& store, const std::string& name);

/// Returns the number by which 'info' and reports call a car: pseudonyms stay in the database.
///
/// \param cars  StoreUsage::cars.
int number_of_car(const std::vector<std::string>& cars, const std::string& car);

} // namespace macadam
