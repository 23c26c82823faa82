#pragma once

#include "storage/text/json.hpp"

#include <string_view>

namespace macadam {

/// Adds the paths of trips to those of an OpenAPI definition.
void add_trip_paths(JsonObject& paths);

/// Security schemes of these paths, a JSON object.
extern const std::string_view trip_security_schemes;

} // namespace macadam
