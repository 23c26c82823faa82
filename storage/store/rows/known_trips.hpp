#pragma once

#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace macadam {

/// Row of a trip; `std::nullopt` if the database does not contain it.
std::optional<std::int64_t> row_of_trip(Database& database, const std::string& sha256);

// Tombstone of a forgotten trip: a hash of its hash. Only a holder of the log can recognise the
// trip by it.

std::string forgotten_mark(const std::string& sha256);
bool is_forgotten(Database& database, const std::string& sha256);
void mark_forgotten(Database& database, const std::string& sha256);
void unmark_forgotten(Database& database, const std::string& sha256);

} // namespace macadam
