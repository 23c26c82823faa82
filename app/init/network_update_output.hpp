#pragma once

#include "storage/store/records/store_records.hpp"

#include <string>

namespace macadam {

/// Formats the result of a network update as a table for people.
std::string text_of(const NetworkUpdate& update);

/// Formats the result as one JSON object.
std::string json_of(const NetworkUpdate& update);

} // namespace macadam
