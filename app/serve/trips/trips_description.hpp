#pragma once

#include "storage/text/json.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace macadam {

// Paths for holders of tokens.

/// Adds the paths of trips to those of an OpenAPI definition.
void add_trip_paths(JsonObject& paths);

/// Adds the paths of the collection of trips.
/// \param of_items  parameters of .../items, each an object of OpenAPI
void add_trip_collection_paths(JsonObject& paths, const std::vector<std::string>& of_items);

/// Adds the paths of the queue of a database on a server.
void add_queue_paths(JsonObject& paths);

/// Security schemes of these paths, a JSON object.
extern const std::string_view trip_security_schemes;

} // namespace macadam
