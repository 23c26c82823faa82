#pragma once

#include "storage/postgres/server_connection.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace macadam {

/// Server that holds cells of a database on another one, its front.
struct CellServer {
    std::string name;       ///< of the foreign server in the front's catalogue
    std::string connection; ///< "host='...' dbname='...' ...", without a password
};

/// Finds the server behind an address among those that hold cells.
std::optional<CellServer> cell_server_at(ServerConnection& front, const std::string& address);

/// Makes a database on another server ready to hold cells of this one: tables and functions there,
/// a foreign server and functions of PL/Proxy here. The first one also takes the keys of the tables
/// `drive` and `segment_state` from the whole to their partitions, since foreign ones have none.
/// The front's server connects to the address itself, with passwords of its own.
///
/// \throws InputError  if the role is no superuser of the front, which only may do this; if the
///                     other database has a schema `macadam`, or cannot be reached.
CellServer add_cell_server(ServerConnection& front, const std::string& address);

/// Base name of the tables of a cell on another server: "drive_34521_7".
std::string cell_table(const std::string& parent, std::int32_t cell, std::int64_t number);

} // namespace macadam
