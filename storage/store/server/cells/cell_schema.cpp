#include "storage/store/server/cells/cell_schema.hpp"

#include "estimator/common/error.hpp"
#include "storage/postgres/idle_limit.hpp"
#include "storage/postgres/role_grants.hpp"
#include "storage/postgres/server_address.hpp"
#include "storage/store/server/reader_rights.hpp"
#include "storage/store/server/server_locks.hpp"
#include "storage/store/server/server_tables.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace macadam {
namespace {

// Parts of the texts below: {columns} "cell, chunk, ..." of table drive, {arrays} "cell integer[],
// ...", {values} "$3, $4, ...", as many.

/// On the front, as a superuser, with whose rights PL/Proxy connects: whoever owns the roads could
/// otherwise lead it to any server that trusts this one.
constexpr const char* front_addresses = R"sql(
CREATE SCHEMA macadam_cells;
CREATE TABLE macadam_cells.address (name text PRIMARY KEY, connection text NOT NULL UNIQUE);
CREATE FUNCTION macadam_cells.connection_of(server text) RETURNS text LANGUAGE sql STABLE
SET search_path = pg_catalog AS 'SELECT connection FROM macadam_cells.address WHERE name = server';
COMMENT ON SCHEMA macadam_cells IS 'Addresses of other servers that hold cells of the road database';
COMMENT ON TABLE macadam_cells.address IS 'Other servers that hold cells of this database';
COMMENT ON COLUMN macadam_cells.address.name IS 'Name of the foreign server';
COMMENT ON COLUMN macadam_cells.address.connection IS 'How this server connects to it; passwords are in .pgpass of its user';
COMMENT ON FUNCTION macadam_cells.connection_of(text) IS 'How this server connects to one that holds cells';
)sql";

/// On the front, as its owner.
constexpr const char* front_tables = R"sql(
CREATE TABLE macadam.cell_place (
    cell integer PRIMARY KEY,
    server text NOT NULL REFERENCES macadam_cells.address,
    number bigint NOT NULL
);
CREATE SEQUENCE macadam.cell_number;
CREATE TABLE macadam.unfinished (trip bigint PRIMARY KEY, at timestamptz NOT NULL DEFAULT now());
COMMENT ON TABLE macadam.cell_place IS 'Cells on other servers';
COMMENT ON COLUMN macadam.cell_place.cell IS 'Map tile of zoom 8, as the number of its quadkey';
COMMENT ON COLUMN macadam.cell_place.server IS 'Server that holds its drives and fused values';
COMMENT ON COLUMN macadam.cell_place.number IS 'Number that ends the names of its tables there';
COMMENT ON SEQUENCE macadam.cell_number IS 'Numbers of tables on other servers';
COMMENT ON TABLE macadam.unfinished IS 'Trips whose drives other servers may have, though the trip was not stored: to be removed there';
COMMENT ON COLUMN macadam.unfinished.trip IS 'Row that the trip would have had';
COMMENT ON COLUMN macadam.unfinished.at IS 'When its drives were sent';

CREATE OR REPLACE FUNCTION macadam.add_cell(cell integer) RETURNS void
LANGUAGE plpgsql SET search_path = pg_catalog AS $$
DECLARE
    parent text;
    keys text;
BEGIN
    FOR parent, keys IN VALUES ('segment', NULL), ('drive', 'cell, chunk, trip, drive'),
                               ('segment_state', 'cell, fid') LOOP
        EXECUTE format('CREATE TABLE macadam.%I PARTITION OF macadam.%I FOR VALUES IN (%s)',
                       parent || '_' || cell, parent, cell);
        EXECUTE format('COMMENT ON TABLE macadam.%I IS %L', parent || '_' || cell,
                       'Rows of table ' || parent || ' in map tile ' || cell);
        IF keys IS NOT NULL THEN
            EXECUTE format('ALTER TABLE macadam.%I ADD PRIMARY KEY (%s)',
                           parent || '_' || cell, keys);
        END IF;
    END LOOP;
END $$;

-- Keys go from the whole to its partitions, which keep theirs while they are detached.
DO $$
DECLARE
    part record;
    statement text;
    attaching text[] := '{}';
BEGIN
    FOR part IN SELECT inhrelid::regclass AS name, inhparent::regclass AS parent,
                       pg_get_expr(relpartbound, inhrelid) AS bounds
                FROM pg_inherits JOIN pg_class ON pg_class.oid = inhrelid
                WHERE inhparent IN ('macadam.drive'::regclass, 'macadam.segment_state'::regclass) LOOP
        EXECUTE format('ALTER TABLE %s DETACH PARTITION %s', part.parent, part.name);
        attaching := attaching || format('ALTER TABLE %s ATTACH PARTITION %s %s',
                                         part.parent, part.name, part.bounds);
    END LOOP;
    FOR statement IN SELECT format('ALTER TABLE %s DROP CONSTRAINT %I', conrelid::regclass, conname)
                     FROM pg_constraint WHERE contype IN ('p', 'f')
                     AND conrelid IN ('macadam.drive'::regclass, 'macadam.segment_state'::regclass) LOOP
        EXECUTE statement;
    END LOOP;
    FOREACH statement IN ARRAY attaching LOOP
        EXECUTE statement;
    END LOOP;
END $$;
)sql";

/// On the front, as a superuser: functions that run on the server named by their first argument.
constexpr const char* front_functions = R"sql(
CREATE EXTENSION IF NOT EXISTS postgres_fdw SCHEMA public;
CREATE EXTENSION IF NOT EXISTS plproxy SCHEMA public;
CREATE FUNCTION macadam.put_drives(server text, target text, {arrays}) RETURNS bigint
LANGUAGE plproxy AS $$ CONNECT macadam_cells.connection_of(server); $$;
CREATE FUNCTION macadam.add_cell_tables(server text, cell integer, number bigint, copied bigint)
RETURNS bigint LANGUAGE plproxy AS $$ CONNECT macadam_cells.connection_of(server); $$;
CREATE FUNCTION macadam.drop_cell_tables(server text, kept bigint[])
RETURNS bigint LANGUAGE plproxy AS $$ CONNECT macadam_cells.connection_of(server); $$;
CREATE FUNCTION macadam.await_standby(server text) RETURNS pg_lsn LANGUAGE plproxy AS $$
    CONNECT macadam_cells.connection_of(server);
    SELECT pg_catalog.pg_logical_emit_message(true, 'macadam', '');
$$;
COMMENT ON FUNCTION macadam.put_drives IS 'Stores drives in a table of another server, in a transaction of its own; what is there already stays';
COMMENT ON FUNCTION macadam.await_standby IS 'Commits on another server, which ends, or warns, as those before it did that waited for a standby';
COMMENT ON FUNCTION macadam.add_cell_tables IS 'Creates tables of a cell on another server, filled from those of another number there';
COMMENT ON FUNCTION macadam.drop_cell_tables IS 'Removes tables of cells on another server but those of these numbers';
REVOKE ALL ON FUNCTION macadam.put_drives, macadam.await_standby, macadam.add_cell_tables, macadam.drop_cell_tables
FROM PUBLIC;
)sql";

/// On a server that holds cells: the same functions, and empty tables, as which those are made that
/// hold rows.
constexpr const char* cell_functions = R"sql(
CREATE TABLE macadam.filled (number bigint PRIMARY KEY);
COMMENT ON TABLE macadam.filled IS 'Tables of cells whose rows are all there';
COMMENT ON COLUMN macadam.filled.number IS 'Number that ends their names';
CREATE INDEX drive_of_trip ON macadam.drive (trip);
COMMENT ON INDEX macadam.drive_of_trip IS 'Drives of a trip, to forget it';
CREATE FUNCTION macadam.put_drives(server text, target text, {arrays}) RETURNS bigint
LANGUAGE plpgsql SET search_path = pg_catalog AS $$
DECLARE
    added bigint;
BEGIN
    EXECUTE format('INSERT INTO macadam.%I ({columns}) SELECT * FROM unnest({places})'
                   ' ON CONFLICT DO NOTHING', target) USING {values};
    GET DIAGNOSTICS added = ROW_COUNT;
    RETURN added;
END $$;
CREATE FUNCTION macadam.add_cell_tables(server text, cell integer, number bigint, copied bigint)
RETURNS bigint LANGUAGE plpgsql SET search_path = pg_catalog AS $$
DECLARE
    parent text;
    new_name text;
    added bigint;
    all_rows bigint := 0;
BEGIN
    FOREACH parent IN ARRAY ARRAY['drive', 'segment_state'] LOOP
        new_name := parent || '_' || cell || '_' || number;
        EXECUTE format('CREATE TABLE macadam.%I (LIKE macadam.%I INCLUDING ALL)', new_name, parent);
        EXECUTE format('COMMENT ON TABLE macadam.%I IS %L', new_name,
                       'Rows of table ' || parent || ' in map tile ' || cell);
        IF copied IS NOT NULL THEN
            EXECUTE format('INSERT INTO macadam.%I SELECT * FROM macadam.%I', new_name,
                           parent || '_' || cell || '_' || copied);
            GET DIAGNOSTICS added = ROW_COUNT;
            all_rows := all_rows + added;
        END IF;
    END LOOP;
    RETURN all_rows;
END $$;
CREATE FUNCTION macadam.drop_cell_tables(server text, kept bigint[]) RETURNS bigint
LANGUAGE plpgsql SET search_path = pg_catalog SET lock_timeout = '2s' AS $$
DECLARE
    leaving text;
    dropped bigint := 0;
BEGIN
    FOR leaving IN SELECT relname FROM pg_class WHERE relnamespace = 'macadam'::regnamespace
                   AND relkind = 'r' AND relname ~ '^(drive|segment_state)_\d+_\d+$'
                   AND substring(relname FROM '\d+$')::bigint <> ALL (kept) LOOP
        BEGIN
            EXECUTE format('DROP TABLE macadam.%I', leaving);
            dropped := dropped + 1;
        EXCEPTION WHEN lock_not_available THEN
            NULL; -- read at the moment: next time
        END;
    END LOOP;
    DELETE FROM macadam.filled WHERE number <> ALL (kept);
    RETURN dropped;
END $$;
COMMENT ON FUNCTION macadam.put_drives IS 'Stores drives in a table; what is there already stays';
COMMENT ON FUNCTION macadam.add_cell_tables IS 'Creates tables of a cell, filled from those of another number';
COMMENT ON FUNCTION macadam.drop_cell_tables IS 'Removes tables of cells but those of these numbers';
REVOKE ALL ON FUNCTION macadam.put_drives, macadam.add_cell_tables, macadam.drop_cell_tables FROM PUBLIC;
)sql";

std::string with(std::string text, std::string_view what, std::string_view by) {
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
        text.replace(at, what.size(), by);
    }
    return text;
}

/// "bigint" of "bigint NOT NULL REFERENCES ...".
std::string_view plain_type(const ServerColumn& column) {
    const std::string_view type{column.type};
    return type.substr(0, type.find(' '));
}

std::string with_columns(const char* text) {
    const auto& drive = server_table("drive");
    std::string arrays, places, values;
    int number = 0;
    for (const auto& column : drive.columns) {
        const auto* const comma = number++ == 0 ? "" : ", ";
        arrays += fmt::format("{}{} {}[]", comma, column.name, plain_type(column));
        places += fmt::format("{}${}", comma, number);
        values += fmt::format("{}${}", comma, number + 2); // after server and target
    }
    return with(with(with(with(text, "{arrays}", arrays), "{places}", places), "{values}", values),
                "{columns}",
                column_list(drive));
}

std::string table_of_cells(const ServerTable& table) {
    std::string text;
    std::string comments = fmt::format("COMMENT ON TABLE macadam.{} IS 'As which tables of cells "
                                       "are made; empty';\n",
                                       table.name);
    for (const auto& column : table.columns) {
        std::string_view type{column.type};
        type = type.substr(0, type.find(" REFERENCES"));
        text += fmt::format("{} {}, ", column.name, type);
        comments += fmt::format("COMMENT ON COLUMN macadam.{}.{} IS '{}';\n",
                                table.name,
                                column.name,
                                with(column.meaning, "'", "''"));
    }
    return fmt::format(
        "CREATE TABLE macadam.{} ({}{});\n{}", table.name, text, table.constraints, comments);
}

void create_cell_schema(ServerConnection& cell) {
    if (cell.number("SELECT count(*) FROM pg_namespace WHERE nspname = 'macadam'") != 0) {
        throw InputError{fmt::format("{}: already has a schema macadam, expected a database "
                                     "without one",
                                     cell.address())};
    }
    cell.run("CREATE SCHEMA macadam;"
             "COMMENT ON SCHEMA macadam IS 'Cells of a road database on another server'");
    cell.run(table_of_cells(server_table("drive")));
    cell.run(table_of_cells(server_table("segment_state")));
    cell.run(with_columns(cell_functions));
}

/// Settings with which the front's server connects. A server that is gone without a word is given
/// up after 20 s, as by ServerConnection.
ConnectionSettings settings_of(const std::string& address) {
    auto settings = connection_settings(address);
    for (const auto& [keyword, value] : {std::pair{"connect_timeout", "10"},
                                         {"tcp_user_timeout", "20000"},
                                         {"keepalives_idle", "10"},
                                         {"keepalives_interval", "5"},
                                         {"keepalives_count", "2"}}) {
        settings.try_emplace(keyword, value);
    }
    return settings;
}

void add_foreign_server(ServerConnection& front,
                        const CellServer& server,
                        const std::string& address) {
    std::string options = "fetch_size '10000', batch_size '1000', use_remote_estimate 'true'";
    std::string user;
    for (const auto& [keyword, value] : settings_of(address)) {
        (keyword == "user" ? user : options) += fmt::format(
            "{}{} '{}'", keyword == "user" ? "" : ", ", keyword, with(value, "'", "''"));
    }
    front.run(fmt::format(
        "CREATE SERVER {} FOREIGN DATA WRAPPER postgres_fdw OPTIONS ({})", server.name, options));
    // Rights are those on the front's tables; the front itself has the password, or needs none.
    front.run(fmt::format("CREATE USER MAPPING FOR PUBLIC SERVER {} OPTIONS ({}{}"
                          "password_required 'false')",
                          server.name,
                          user,
                          user.empty() ? "" : ", "));
    front.run(granting_to_owner(fmt::format("USAGE ON FOREIGN SERVER {}", server.name)));
    act_as_owner(front);
    front.run(fmt::format("CREATE FOREIGN TABLE macadam.filled_{0} (number bigint) SERVER {0}"
                          " OPTIONS (schema_name 'macadam', table_name 'filled');"
                          "COMMENT ON FOREIGN TABLE macadam.filled_{0} IS"
                          " 'Tables of cells on another server whose rows are all there';"
                          "COMMENT ON COLUMN macadam.filled_{0}.number IS"
                          " 'Number that ends their names'",
                          server.name));
    front.run("RESET ROLE");
}

std::string connection_text(const std::string& address) {
    std::string text;
    for (const auto& [keyword, value] : settings_of(address)) {
        text += fmt::format("{}{}='{}'",
                            text.empty() ? "" : " ",
                            keyword,
                            with(with(value, "\\", "\\\\"), "'", "\\'"));
    }
    return text;
}

/// Prepares a database for cells on other servers.
void create_front(ServerConnection& front) {
    const auto importers = {std::string_view{"macadam_importer"},
                            std::string_view{"macadam_operator"}};
    constexpr const char* use_schema = "USAGE ON SCHEMA macadam_cells";
    constexpr const char* see_addresses = "SELECT, REFERENCES ON macadam_cells.address";
    front.run(front_addresses + granting(use_schema, importers) + granting_to_owner(use_schema) +
              granting(see_addresses, importers) + granting_to_owner(see_addresses));
    act_as_owner(front);
    front.run(front_tables + granting("SELECT ON macadam.cell_place", importers) +
              granting("SELECT, INSERT, UPDATE, DELETE ON macadam.unfinished", importers));
    front.run("RESET ROLE");
    front.run(with_columns(front_functions) +
              granting("EXECUTE ON FUNCTION macadam.put_drives, macadam.await_standby", importers) +
              granting_to_owner("EXECUTE ON FUNCTION macadam.put_drives, macadam.await_standby,"
                                " macadam.add_cell_tables, macadam.drop_cell_tables"));
}

} // namespace

std::string cell_table(const std::string& parent, std::int32_t cell, std::int64_t number) {
    return fmt::format("{}_{}_{}", parent, cell, number);
}

std::optional<CellServer> cell_server_at(ServerConnection& front, const std::string& address) {
    const auto settings = settings_of(address);
    if (!has_cells(front)) {
        return std::nullopt;
    }
    for (const auto& row : front.rows("SELECT name, connection FROM macadam_cells.address")) {
        const auto connection = row[1].value_or("");
        if (settings_of(connection) == settings) { // also of an earlier version, with fewer of them
            return CellServer{row[0].value_or(""), connection};
        }
    }
    return std::nullopt;
}

CellServer add_cell_server(ServerConnection& front, const std::string& address) {
    if (!front.is_superuser()) {
        throw InputError{fmt::format("{}: only a superuser of this server adds another one, since "
                                     "PL/Proxy and postgres_fdw connect with its rights",
                                     front.address())};
    }
    ServerConnection cell{address};
    cell.begin(false);
    set_idle_limit(cell, "0"); // the front is waited for, and nobody waits for the new server
    create_cell_schema(cell);
    take_database(front); // changes of tables that importers use would stop in one another's way
    ServerTransaction all{front};
    if (!has_cells(front)) {
        create_front(front);
    }
    CellServer server;
    server.name = fmt::format("macadam_cells_{}",
                              front.number("SELECT count(*) + 1 FROM macadam_cells.address"));
    server.connection = connection_text(address);
    add_foreign_server(front, server, address);
    front.rows("INSERT INTO macadam_cells.address VALUES ($1, $2)",
               {server.name, server.connection});
    set_idle_limit(front, "0"); // a lost standby holds the new server up
    cell.commit();
    all.commit();
    release_database(front);
    return server;
}

} // namespace macadam
