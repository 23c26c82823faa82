#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/commands.hpp"

#include <filesystem>

namespace macadam {

/// STORE operand of commands that also read a database on a server.
inline constexpr Operand source_operand{
    "STORE",
    "The road database: a .gpkg file made by 'macadam init', or postgresql://... made by 'macadam "
    "copy'."};

/// STORE operand of commands that import into a file or a server.
inline constexpr Operand import_operand{
    "STORE", "The road database: a .gpkg file or postgresql://..., made by 'macadam init'."};

/// Returns the STORE operand, which may be the address of a PostgreSQL server.
/// \throws UsageError  for an address with a password, or of another kind of server.
std::filesystem::path file_or_server(const Arguments& arguments);

} // namespace macadam
