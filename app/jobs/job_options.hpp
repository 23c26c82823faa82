#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "storage/postgres/server_connection.hpp"

#include <string>

namespace macadam {

inline constexpr Operand server_operand{
    "STORE", "The road database: postgresql://USER@HOST/DATABASE, made by 'macadam copy'."};

inline constexpr Option objects_option{
    "--objects",
    "DIR|s3://...",
    "Where logs wait: a folder that all machines see, or s3://BUCKET/PREFIX.",
    "as submitted last"};

/// Returns the STORE operand of a command that works with servers only.
/// \throws UsageError  for a file, or an address with a password.
std::string server_of(const Arguments& arguments);

/// Opens a database of this version on a server.
/// \throws InputError  if it is none.
ServerConnection opened_server(const std::string& address);

/// Returns --objects or, without it, where logs were submitted to last.
/// \throws UsageError  if neither is known.
std::string objects_of(const Arguments& arguments, ServerConnection& server);

} // namespace macadam
