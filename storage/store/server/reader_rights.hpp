#pragma once

#include "storage/postgres/server_connection.hpp"

#include <string>
#include <vector>

namespace macadam {

/// Takes the role of the owner of schema `macadam` until the end of the transaction, so that what
/// is created belongs to it.
///
/// \throws InputError  if the role may not.
void act_as_owner(ServerConnection& server);

/// Tests whether a database on a server is a crowd's.
bool is_crowd(ServerConnection& server);

/// Lets roles that may not read trips see of a crowd's database only its roads and publications: by
/// tables, the view for QGIS and, where this role is a superuser, statistics, sizes and locks of
/// the server, which would tell how many trips come in, and where. Within the caller's transaction;
/// a repetition includes roles that were given the view since.
///
/// \throws InputError  if the role does not own the schema.
void show_publications_alone(ServerConnection& server);

/// Tests whether statistics, sizes and locks of the server are open to all its roles.
bool is_activity_open(ServerConnection& server);

/// Lists other databases of the server to which all its roles may connect: there, too, they see
/// locks and statistics of this one.
std::vector<std::string> open_databases_beside(ServerConnection& server);

/// Refuses a crowd on several servers: readers' rights are those of one.
///
/// \throws InputError  if other servers hold cells.
void expect_one_server(ServerConnection& server);

} // namespace macadam
