#include "storage/store/server/server_locks.hpp"

#include "storage/postgres/server_array.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

// First numbers of our pairs: the letters "maca" and so on.
constexpr int of_database = 0x6d616361;
constexpr int of_imports = 0x6d616362;
constexpr int of_cells = 0x6d616363;
constexpr int of_old_changes = 0x6d616364;
constexpr int of_deletions = 0x6d616365;
constexpr int of_all_places = -1; // beside the numbers of cells

} // namespace

ServerStatement sharing_database() {
    return ServerStatement{fmt::format("SELECT pg_advisory_xact_lock_shared({}, 0)", of_database)};
}

void share_database(ServerConnection& server) {
    server.rows(sharing_database().sql);
}

void take_database(ServerConnection& server) {
    server.rows(fmt::format("SELECT pg_advisory_lock({}, 0)", of_database));
}

ServerStatement asking_for_cells() {
    return ServerStatement{"SELECT (to_regclass('macadam.cell_place') IS NOT NULL)::integer"};
}

bool has_cells(ServerConnection& server) {
    return server.number(asking_for_cells().sql) != 0;
}

ServerStatement sharing_cells(const std::set<std::int32_t>& cells) {
    return ServerStatement{fmt::format("SELECT pg_advisory_xact_lock_shared({}, cell)"
                                       " FROM unnest($1::integer[]) AS cell",
                                       of_cells),
                           {array_of(cells)}};
}

void share_cells(ServerConnection& server, const std::set<std::int32_t>& cells) {
    const auto sharing = sharing_cells(cells);
    server.rows(sharing.sql, sharing.values);
}

void take_cell(ServerConnection& server, std::int32_t cell) {
    server.rows(fmt::format("SELECT pg_advisory_xact_lock({}, {})", of_cells, cell));
}

void take_cell_places(ServerConnection& server) {
    server.rows(fmt::format("SELECT pg_advisory_lock({}, {})", of_cells, of_all_places));
}

void stop_writers(ServerConnection& server) {
    if (has_cells(server)) {
        take_database(server);
    }
}

void see_all_cells(ServerConnection& server) {
    if (has_cells(server)) {
        server.run("LOCK TABLE macadam.drive, macadam.segment_state IN ACCESS SHARE MODE");
        server.run("SELECT count(*) FROM macadam.drive WHERE trip = -1");
        release_database(server);
    }
}

bool try_take_old_changes(ServerConnection& server) {
    return server.number(fmt::format("SELECT pg_try_advisory_xact_lock({}, 0)::integer",
                                     of_old_changes)) != 0;
}

bool try_take_deletions(ServerConnection& server) {
    return server.number(
               fmt::format("SELECT pg_try_advisory_xact_lock({}, 0)::integer", of_deletions)) != 0;
}

void release_database(ServerConnection& server) {
    server.rows(fmt::format("SELECT pg_advisory_unlock({}, 0)", of_database));
}

std::int32_t number_of_import(const std::string& name) {
    std::uint32_t hash = 2166136261; // FNV-1a
    for (const char c : name) {
        hash = (hash ^ static_cast<unsigned char>(c)) * 16777619;
    }
    return static_cast<std::int32_t>(hash >> 1);
}

void take_import_lock(ServerConnection& server, std::int32_t import) {
    server.rows(fmt::format("SELECT pg_advisory_lock_shared({}, {})", of_imports, import));
}

void release_import_lock(ServerConnection& server, std::int32_t import) {
    server.rows(fmt::format("SELECT pg_advisory_unlock_shared({}, {})", of_imports, import));
}

bool is_other_importing(ServerConnection& server, const std::optional<std::int32_t>& import) {
    return server.number(fmt::format(
               "SELECT count(*) FROM pg_locks WHERE locktype = 'advisory' AND classid = {}"
               " AND database = (SELECT oid FROM pg_database WHERE datname = current_database())"
               " AND pid <> pg_backend_pid() AND {}",
               of_imports,
               import ? fmt::format("objid = {}", *import) : std::string{"true"})) != 0;
}

} // namespace macadam
