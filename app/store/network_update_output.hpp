#pragma once

#include "storage/store/road_store.hpp"

#include <string>

namespace macadam {

/// What an update of a store's network did, as a table for people.
std::string text_of(const NetworkUpdate& update);

/// The same as one JSON object.
std::string json_of(const NetworkUpdate& update);

} // namespace macadam
