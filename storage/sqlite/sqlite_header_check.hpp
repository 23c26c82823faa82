#pragma once

#include <filesystem>

namespace macadam {

/// Checks the first bytes of a file that should be a road database, before SQLite opens it
/// as one. Locks that SQLite holds on the file in this process stay.
///
/// \throws InputError  if the file does not exist or is not an SQLite database; the message says
///                     what it is.
void expect_store_file(const std::filesystem::path& file);

} // namespace macadam
