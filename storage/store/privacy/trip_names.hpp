#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace macadam {

// Names of trips and of their files often begin with the id of the car. The database does not store
// the id and replaces it by "*".

/// Replaces the vehicle id in a name by "*"; an empty id leaves the name unchanged.
std::string without_vehicle_id(std::string_view name, std::string_view vehicle_id);

/// Candidate interpretation of a name: a vehicle id within it, and the remaining name.
struct NameReading {
    std::string vehicle_id;
    std::string kept; ///< name without the id
};

/// All interpretations of a name, one for each distinct substring: some ten thousand for a name of
/// 200 letters.
std::vector<NameReading> readings_of_name(std::string_view name);

/// Substring of `name` whose name in databases of version 2 (unkeyed_name_of()) is `unkeyed`; "" if
/// there is none.
std::string text_of_unkeyed_name(std::string_view name, std::string_view unkeyed);

} // namespace macadam
