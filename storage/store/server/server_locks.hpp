#pragma once

#include "storage/postgres/server_connection.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace macadam {

// Advisory locks of a database on a server. A chunk is locked by the number of its first row.

/// Shares the database with other importers until the end of the transaction; waits for who has it
/// alone. A statement of its own, so that later ones see what he wrote.
void share_database(ServerConnection& server);

/// Takes the database alone, until the end of the connection; waits for all others.
void take_database(ServerConnection& server);

/// Number that stands for an import, from its name.
std::int32_t number_of_import(const std::string& name);

/// Shows an import as running until it is released or the connection ends. It excludes nobody.
void take_import_lock(ServerConnection& server, std::int32_t import);
void release_import_lock(ServerConnection& server, std::int32_t import);

/// Tests whether another connection imports; with a number, that import.
bool is_other_importing(ServerConnection& server, const std::optional<std::int32_t>& import);

} // namespace macadam
