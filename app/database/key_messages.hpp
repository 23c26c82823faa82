#pragma once

#include "app/cli/console.hpp"
#include "storage/store/import_store.hpp"

#include <filesystem>

namespace macadam {

/// Warns if users other than its owner can read the key beside the database.
void warn_of_open_key(const StoreReader& store, const Console& console);

/// Warns if users other than its owner can read the key of kept logs.
void warn_of_open_logs_key(const std::filesystem::path& key_file, const Console& console);

/// Creates a missing key before cars get pseudonyms, and warns of its limits.
void make_missing_key(ImportTarget& trips, const Console& console);

} // namespace macadam
