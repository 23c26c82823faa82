#pragma once

#include "app/cli/console.hpp"
#include "storage/sqlite/lock_wait_policy.hpp"
#include "storage/store/import_store.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/reader/server_reader.hpp"

#include <filesystem>
#include <string>

namespace macadam {

/// Returns the wait policy of a command while another one writes to the database: it names the
/// other process once, and Ctrl-C ends the wait.
LockWaitPolicy wait_policy_for(const std::filesystem::path& store, const Console& console);

/// Warns if a copy on a server was made by a superuser, or is of a crowd and the server's
/// statistics are open.
void warn_of_server(const StoreCopy& copy, const std::string& address, const Console& console);

/// Warns that all roles of a server see what tells of a crowd's trips.
void warn_of_open_activity(const std::string& address, const Console& console);

/// Creates a database, as a file or on a server that has none.
///
/// \throws InputError  if it exists. Nothing remains after a failure.
StoreInfo create_store(const std::filesystem::path& store,
                       const RoadNetwork& roads,
                       const StoreSettings& settings,
                       const Console& console);

/// Opens a database for a command that writes, with that wait policy.
RoadStore opened_store(const std::filesystem::path& file, const Console& console);

/// Opens a database, a file or on a server, to import trips.
ImportStore opened_for_import(const std::filesystem::path& store, const Console& console);

/// Warns if a superuser of the server imports.
void warn_of_importer(const ImportStore& store, const Console& console);

/// Opens a database for a command that reads, with that wait policy.
///
/// \param need  what the command reads: of a database on a server, only that is fetched.
StoreReader opened_reader(const std::filesystem::path& file,
                          const Console& console,
                          Audience audience = Audience::anyone,
                          const ServerNeed& need = {});

} // namespace macadam
