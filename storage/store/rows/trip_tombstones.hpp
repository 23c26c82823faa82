#pragma once

#include "storage/sqlite/sqlite.hpp"

#include <string>

namespace macadam {

// What is left of a trip that was forgotten: a hash of its hash. Who has the log can tell that it
// was here; nothing else can be told from it.

bool is_forgotten(Database& database, const std::string& sha256);
void mark_forgotten(Database& database, const std::string& sha256);
void unmark_forgotten(Database& database, const std::string& sha256);

} // namespace macadam
