#include "storage/store/server/server_schema.hpp"

#include "estimator/common/error.hpp"
#include "storage/jobs/job_schema.hpp"
#include "storage/jobs/upload_schema.hpp"
#include "storage/store/server/reader_rights.hpp"
#include "storage/store/server/server_schema_sql.hpp"
#include "storage/store/server/server_tables.hpp"
#include "storage/styles/road_style.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {
namespace {

/// Text as an SQL literal; of our own constants, which hold no backslashes.
std::string literal(std::string_view text) {
    std::string quoted = "'";
    for (const char c : text) {
        quoted += c == '\'' ? "''" : std::string(1, c);
    }
    return quoted + "'";
}

std::string table_sql(const ServerTable& table, const std::string& postgis) {
    std::string columns;
    std::string comments =
        fmt::format("COMMENT ON TABLE macadam.{} IS {};\n", table.name, literal(table.meaning));
    for (const auto& column : table.columns) {
        std::string type = column.type;
        if (const auto at = type.find("{postgis}"); at != std::string::npos) {
            type.replace(at, std::string_view{"{postgis}"}.size(), postgis);
        }
        columns += fmt::format("    {} {},\n", column.name, type);
        comments += fmt::format("COMMENT ON COLUMN macadam.{}.{} IS {};\n",
                                table.name,
                                column.name,
                                literal(column.meaning));
    }
    const auto partition = table.partition_by != nullptr
                               ? fmt::format(" PARTITION BY LIST ({})", table.partition_by)
                               : std::string{};
    return fmt::format("CREATE TABLE macadam.{} (\n{}    {}\n){};\n{}",
                       table.name,
                       columns,
                       table.constraints,
                       partition,
                       comments);
}

/// Tables that an importer writes: trips, and the values fused from them.
constexpr const char* written_by_importers =
    "macadam.vehicle, macadam.trip, macadam.row_reason, macadam.drive, macadam.event,"
    " macadam.event_search, macadam.segment_state, macadam.chunk_state,"
    " macadam.chunk_dirty, macadam.import_note, macadam.audit, macadam.state_change";

std::string read_by_all() {
    std::string names = "macadam.migration, macadam.roughness";
    for (const auto& table : server_tables()) {
        if (table.use == ServerUse::road) {
            names += fmt::format(", macadam.{}", table.name);
        }
    }
    return names;
}

/// Step after migration 1.
struct Migration {
    int number;
    const char* what;
    std::string sql;
};

/// A new database has the column from its table's definition.
constexpr const char* trimmed_lengths = R"(
ALTER TABLE macadam.trip ADD COLUMN IF NOT EXISTS trimmed_mm bigint NOT NULL DEFAULT 0;
COMMENT ON COLUMN macadam.trip.trimmed_mm IS 'Left out at ends and long stops by the recorder, mm';
)";

std::vector<Migration> migrations() {
    std::vector<Migration> all;
    all.push_back({2, "queue for workers", job_schema()});
    all.push_back({3, "lengths that recorders trimmed", trimmed_lengths});
    all.push_back({4, "changes of chunks and trips", changes_migration_sql()});
    all.push_back({5, "trips of logs", job_trip_schema()});
    all.push_back({6, "marks of each trip", marks_migration_sql});
    all.push_back({7, "publications of crowds", publications_migration_sql()});
    all.push_back({8, "removal of old changes", old_changes_migration_sql});
    all.push_back({9, "times of passes of the whole", seen_migration_sql});
    all.push_back({10, "counts of logs", job_count_schema()});
    all.push_back({11, "narrower rights", narrow_rights_migration_sql});
    all.push_back({12, "tokens and senders of logs", upload_schema()});
    all.push_back({13, "announced logs", announced_log_schema() + forgotten_log_schema()});
    return all;
}

void create_tables(ServerConnection& server, int migration) {
    const auto postgis = postgis_schema(server);
    for (const auto& table : server_tables()) {
        if (table.migration == migration) {
            server.run(table_sql(table, postgis));
        }
    }
}

void run_migrations_after(int version, ServerConnection& server) {
    for (const auto& [number, what, sql] : migrations()) {
        if (number > version) {
            create_tables(server, number);
            server.run(sql);
            server.rows("INSERT INTO macadam.migration VALUES ($1, $2)",
                        {std::to_string(number), what});
        }
    }
}

bool has_schema(ServerConnection& server) {
    return server.number("SELECT count(*) FROM pg_namespace WHERE nspname = 'macadam'") != 0;
}

/// Version of the schema, not newer than this program.
int version_of(ServerConnection& server) {
    if (!has_schema(server)) {
        throw InputError{fmt::format("{0}: has no road database: 'macadam copy roads.gpkg {0}' "
                                     "makes one",
                                     server.address())};
    }
    const auto version = server.number("SELECT coalesce(max(number), 0) FROM macadam.migration");
    if (version > server_schema_version) {
        throw InputError{fmt::format("{}: its schema is of version {}, expected {}: it was made by "
                                     "a newer version of Macadam",
                                     server.address(),
                                     version,
                                     server_schema_version)};
    }
    return static_cast<int>(version);
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
        text.replace(at, what.size(), by);
    }
    return text;
}

} // namespace

std::string postgis_schema(ServerConnection& server) {
    const auto found = server.rows("SELECT quote_ident(nspname) FROM pg_extension"
                                   " JOIN pg_namespace AS n ON n.oid = extnamespace"
                                   " WHERE extname = 'postgis'");
    if (found.size() != 1 || !found[0][0]) {
        throw InputError{fmt::format("{}: has no PostGIS; an administrator of the server adds it "
                                     "with 'CREATE EXTENSION postgis'",
                                     server.address())};
    }
    return *found[0][0];
}

void create_server_schema(ServerConnection& server) {
    if (has_schema(server)) {
        throw InputError{fmt::format("{}: already has a schema macadam, expected a database "
                                     "without one",
                                     server.address())};
    }
    static_cast<void>(postgis_schema(server)); // says what is missing
    server.run(schema_begin_sql);
    create_tables(server, 1);
    server.run(schema_indexes_sql);
    server.run(schema_unpacking_sql);
    server.run(schema_roughness_sql);
    server.run(schema_cells_sql);
    server.run(
        replaced(replaced(schema_roles_sql, "{0}", read_by_all()), "{1}", written_by_importers));
    run_migrations_after(1, server);
}

void add_server_cells(ServerConnection& server, const std::set<std::int32_t>& numbers) {
    for (const auto cell : numbers) {
        server.rows("SELECT macadam.add_cell($1)", {std::to_string(cell)});
    }
}

void add_server_style(ServerConnection& server, const ClassTable& classes) {
    const RoadStyle style{classes};
    server.run("SAVEPOINT style");
    try {
        // As QGIS creates it.
        server.run("CREATE TABLE IF NOT EXISTS public.layer_styles (id serial PRIMARY KEY,"
                   " f_table_catalog varchar, f_table_schema varchar, f_table_name varchar,"
                   " f_geometry_column varchar, stylename text, styleqml xml, stylesld xml,"
                   " useasdefault boolean, description text, owner varchar(63), ui xml,"
                   " update_time timestamp DEFAULT CURRENT_TIMESTAMP, type varchar)");
        server.run("DELETE FROM public.layer_styles WHERE f_table_schema = 'macadam'"
                   " AND f_table_name = 'roughness'");
        server.rows("INSERT INTO public.layer_styles (f_table_catalog, f_table_schema,"
                    " f_table_name, f_geometry_column, stylename, styleqml, stylesld,"
                    " useasdefault, description, owner) VALUES (current_database(), 'macadam',"
                    " 'roughness', 'geom', 'roughness', XMLPARSE(DOCUMENT $1),"
                    " XMLPARSE(DOCUMENT $2), true, $3, current_user)",
                    {qml_style(style), sld_style(style, "roughness"), std::string{classes.title}});
        server.run("GRANT SELECT ON public.layer_styles TO PUBLIC");
    } catch (const InputError&) {
        server.run("ROLLBACK TO SAVEPOINT style"); // the view serves without a style
    }
    server.run("RELEASE SAVEPOINT style");
}

void expect_server_schema(ServerConnection& server) {
    if (const auto version = version_of(server); version < server_schema_version) {
        throw InputError{fmt::format("{0}: its schema is of version {1}, expected {2}: 'macadam "
                                     "upgrade {0}' brings it there",
                                     server.address(),
                                     version,
                                     server_schema_version)};
    }
}

int upgrade_server_schema(ServerConnection& server) {
    server.begin(false);
    static_cast<void>(version_of(server)); // says what is missing
    act_as_owner(server);                  // who would be shut out of tables of another role
    server.run("LOCK TABLE macadam.migration IN SHARE ROW EXCLUSIVE MODE");
    const auto version = version_of(server);
    run_migrations_after(version, server);
    server.commit();
    return version;
}

std::int32_t cell_of_way(std::string_view points) {
    GeoPoint first{};
    if (points.size() >= sizeof first) {
        std::memcpy(&first, points.data(), sizeof first);
    }
    return cell_of(first);
}

std::int32_t cell_of(const GeoPoint& first_node) {
    constexpr int zoom = 8;
    constexpr double tiles = 1 << zoom;
    constexpr double radians = std::numbers::pi / 180;
    const auto tile = [](double share) {
        return static_cast<std::uint32_t>(std::clamp(share * tiles, 0.0, tiles - 1));
    };
    const auto x = tile((first_node.lon_deg + 180) / 360);
    const auto y =
        tile((1 - std::asinh(std::tan(first_node.lat_deg * radians)) / std::numbers::pi) / 2);
    std::uint32_t cell = 0;
    for (int bit = zoom - 1; bit >= 0; --bit) {
        cell = cell << 2 | (y >> bit & 1) << 1 | (x >> bit & 1);
    }
    return static_cast<std::int32_t>(cell);
}

} // namespace macadam
