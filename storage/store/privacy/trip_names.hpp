#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace macadam {

// Names of trips and of their files often begin with the id of the car, which a database does not
// keep: there it is "*".

/// \param vehicle_id  "" leaves the name as it is.
std::string without_vehicle_id(std::string_view name, std::string_view vehicle_id);

/// A way to read a name: as that of a trip of a car.
struct NameReading {
    std::string vehicle_id;
    std::string kept; ///< what is left of the name
};

/// All ways to read it, one for each distinct text in it. Some ten thousand for a name of 200
/// letters.
std::vector<NameReading> readings_of_name(std::string_view name);

/// The text in a name that a database of version 2 called so (unkeyed_name_of()); "" = none does.
std::string text_of_unkeyed_name(std::string_view name, std::string_view unkeyed);

} // namespace macadam
