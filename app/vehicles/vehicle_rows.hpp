#pragma once

#include "estimator/vehicle/vehicle.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// A car that --vehicle or a vehicle_id may name.
struct ListedVehicle {
    Vehicle vehicle;
    std::string stands_for; ///< in words
};

/// Returns the built-in cars with what they stand for.
std::vector<ListedVehicle> listed_built_in_vehicles();

/// Formats cars, one a row: mass, wheelbase, natural frequencies, damping, uncertainty.
///
/// \param format  table, json or csv
std::string vehicles_text(std::span<const ListedVehicle> vehicles, std::string_view format);

/// Formats the parameters of one car, one a row, with unit and uncertainty.
std::string parameters_text(const Vehicle& vehicle, std::string_view format);

/// Returns a sentence for each number that no usual passenger car has.
std::vector<std::string> implausible_in(const Vehicle& vehicle);

} // namespace macadam
