#pragma once

#include <filesystem>

namespace macadam {

/// Looks at the first bytes of a file that should be a store, before SQLite does.
///
/// \throws InputError  if there is none, or it is no SQLite database; says what it is.
void expect_store_file(const std::filesystem::path& file);

} // namespace macadam
