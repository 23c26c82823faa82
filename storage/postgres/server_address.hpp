#pragma once

#include <map>
#include <string>
#include <string_view>

namespace macadam {

/// Tests whether the name of a database is the address of a PostgreSQL server:
/// `postgresql://user@host:5432/database`, or with `postgres://`.
bool is_server_address(std::string_view database);

/// Checks that an address can be shown: in messages, in the history of a shell and in the list of
/// processes.
///
/// \throws InputError  if it is malformed or holds a password; the message repeats no part of it.
void expect_address_without_secrets(const std::string& address);

/// Values by libpq's keyword: host, dbname, user, ...
using ConnectionSettings = std::map<std::string, std::string>;

/// Settings that an address gives.
///
/// \throws InputError  as expect_address_without_secrets().
ConnectionSettings connection_settings(const std::string& address);

/// Name of the database on its server, in letters of file names; "roads" if it has none.
///
/// \throws InputError  for a malformed address.
std::string database_name(const std::string& address);

/// Refuses the address of a server where only a file serves.
///
/// \throws InputError  for an address, with the way around.
void expect_file(std::string_view database);

} // namespace macadam
