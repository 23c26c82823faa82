#pragma once

#include "storage/sqlite/sqlite.hpp"

#include <string>

namespace macadam {

// Tombstone of a forgotten trip: a hash of its hash. Only a holder of the log can recognise the
// trip by it.

bool is_forgotten(Database& database, const std::string& sha256);
void mark_forgotten(Database& database, const std::string& sha256);
void unmark_forgotten(Database& database, const std::string& sha256);

} // namespace macadam
