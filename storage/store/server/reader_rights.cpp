#include "storage/store/server/reader_rights.hpp"

#include "estimator/common/error.hpp"
#include "storage/store/server/server_locks.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace macadam {
namespace {

/// Columns are those of the view of own cars.
constexpr const char* published_roughness = R"sql(
CREATE OR REPLACE VIEW macadam.roughness AS
    SELECT segment.fid, segment.geom, segment.segment, segment.way_id, way.name, way.highway,
           segment.direction, segment.from_m, segment.to_m, state.iri, state.iri_sd, state.iri_low,
           state.iri_high, state.iri_left, state.iri_right, state."index", state.class,
           state.passes::integer AS passes, state.vehicles::integer AS vehicles,
           state.first_seen::date AS first_seen, state.last_seen::date AS last_seen,
           state.trend_per_year, state.trend_sd, state.changed::date AS changed, state.change,
           state.validity
    FROM macadam.published_state AS state
    JOIN macadam.segment ON segment.fid = state.fid
    JOIN macadam.way ON way.way_id = segment.way_id;
COMMENT ON VIEW macadam.roughness IS
    'Published roughness (IRI, mm/m) of the segments; QGIS shows it with its style';
)sql";

/// Of settings, readers see what their copies need: others would tell how many cars there are, when
/// trips were forgotten, and how long logs are kept.
constexpr const char* readers_settings = R"sql(
ALTER TABLE macadam.meta ENABLE ROW LEVEL SECURITY;
DROP POLICY IF EXISTS of_those_who_read_trips ON macadam.meta;
DROP POLICY IF EXISTS of_all ON macadam.meta;
CREATE POLICY of_those_who_read_trips ON macadam.meta
    USING (has_table_privilege('macadam.trip', 'SELECT'));
CREATE POLICY of_all ON macadam.meta FOR SELECT USING (key IN
    ('attribution', 'class_table', 'network_m', 'network_rows', 'network_sha256', 'network_source',
     'privacy', 'published_rows', 'rows_in_order', 'segment_length_m', 'segments'));
)sql";

/// All that a role without trips has is taken away, whoever granted it, of columns, too; the view
/// stands for what it gets instead. Others keep what they have, but no longer hand it on.
constexpr const char* readers_tables = R"sql(
DO $$
DECLARE
    reader text;
    sees_map boolean;
BEGIN
    FOR reader IN
        SELECT DISTINCT grantee::regrole FROM pg_class CROSS JOIN aclexplode(relacl)
        WHERE relnamespace = 'macadam'::regnamespace AND is_grantable AND grantee <> relowner
    LOOP
        EXECUTE format('REVOKE GRANT OPTION FOR ALL ON ALL TABLES IN SCHEMA macadam FROM %s CASCADE',
                       reader);
    END LOOP;
    FOR reader, sees_map IN
        SELECT CASE grantee WHEN 0 THEN 'PUBLIC' ELSE grantee::regrole::text END,
               bool_or(relname = 'roughness')
        FROM (SELECT relname, relacl AS acl FROM pg_class
              WHERE relnamespace = 'macadam'::regnamespace
              UNION ALL SELECT relname, attacl FROM pg_attribute JOIN pg_class ON pg_class.oid = attrelid
              WHERE relnamespace = 'macadam'::regnamespace) AS granted CROSS JOIN aclexplode(acl)
        WHERE grantee = 0 OR NOT has_table_privilege(nullif(grantee, 0), 'macadam.trip', 'SELECT')
        GROUP BY grantee
    LOOP
        EXECUTE format('REVOKE ALL ON ALL TABLES IN SCHEMA macadam FROM %s CASCADE', reader);
        EXECUTE format('REVOKE ALL ON ALL SEQUENCES IN SCHEMA macadam FROM %s CASCADE', reader);
        IF sees_map THEN
            EXECUTE format('GRANT SELECT ON macadam.roughness, macadam.meta, macadam.migration,'
                           ' macadam.way, macadam.segment, macadam.background, macadam.place,'
                           ' macadam.road_ref, macadam.published_state, macadam.published_figure,'
                           ' macadam.published_event TO %s', reader);
            EXECUTE format('GRANT SELECT (number, month, segments, length_m, left_segments, left_m,'
                           ' trips, cars) ON macadam.publication TO %s', reader);
        END IF;
    END LOOP;
END $$;
)sql";

/// By a superuser. Who works on trips needs some of these functions.
constexpr const char* hidden_activity = R"sql(
DO $$
DECLARE
    part text;
    worker text;
    workers text[] := ARRAY(SELECT nspowner::regrole::text FROM pg_namespace WHERE nspname = 'macadam'
        UNION SELECT grantee::regrole::text FROM pg_class CROSS JOIN aclexplode(relacl)
        WHERE pg_class.oid = 'macadam.trip'::regclass AND grantee <> 0);
BEGIN
    FOR part IN SELECT 'FUNCTION ' || oid::regprocedure FROM pg_proc
        WHERE (pronamespace = 'pg_catalog'::regnamespace OR proname ~ '^pg_stat_statements')
        AND (proname ~
        '^pg_(stat_|try_advisory_|advisory_|current_wal_|last_wal_|control_checkpoint|control_recovery)'
        OR proname IN ('pg_lock_status', 'pg_blocking_pids', 'pg_safe_snapshot_blocking_pids',
        'pg_relation_size', 'pg_table_size', 'pg_indexes_size', 'pg_total_relation_size',
        'pg_database_size', 'pg_tablespace_size', 'pg_get_replication_slots', 'pg_prepared_xact',
        'pg_isolation_test_session_is_blocked', 'pg_last_committed_xact',
        'pg_xact_commit_timestamp', 'pg_last_xact_replay_timestamp'))
        AND has_function_privilege('public', oid, 'EXECUTE')
    LOOP
        EXECUTE format('REVOKE EXECUTE ON %s FROM PUBLIC', part);
        FOREACH worker IN ARRAY workers LOOP
            EXECUTE format('GRANT EXECUTE ON %s TO %s', part, worker);
        END LOOP;
    END LOOP;
    SELECT string_agg(quote_ident(attname), ', ') INTO part FROM pg_attribute
        WHERE attrelid = 'pg_catalog.pg_class'::regclass AND attnum > 0 AND NOT attisdropped
        AND attname NOT IN ('relpages', 'reltuples', 'relallvisible', 'relfrozenxid', 'relminmxid');
    REVOKE SELECT ON pg_catalog.pg_class FROM PUBLIC;
    EXECUTE format('GRANT SELECT (%s) ON pg_catalog.pg_class TO PUBLIC', part);
    FOREACH worker IN ARRAY workers LOOP
        EXECUTE format('GRANT SELECT ON pg_catalog.pg_class TO %s', worker);
    END LOOP;
END $$;
)sql";

} // namespace

void act_as_owner(ServerConnection& server) {
    const auto owner = server.rows("SELECT nspowner::regrole FROM pg_namespace"
                                   " WHERE nspname = 'macadam'");
    server.run(fmt::format("SET LOCAL ROLE {}", owner.at(0).at(0).value_or("")));
}

bool is_crowd(ServerConnection& server) {
    return server.number("SELECT count(*) FROM macadam.meta WHERE key = 'privacy'"
                         " AND value = 'crowd'") != 0;
}

void show_publications_alone(ServerConnection& server) {
    if (server.number("SELECT pg_has_role(nspowner, 'USAGE')::integer FROM pg_namespace"
                      " WHERE nspname = 'macadam'") == 0) {
        throw InputError{fmt::format("{}: the role does not own the database, expected its owner, "
                                     "who gives readers the publications in place of the fused "
                                     "values",
                                     server.address())};
    }
    expect_one_server(server);
    server.run(published_roughness);
    server.run(readers_settings);
    server.run(readers_tables);
    if (server.is_superuser()) {
        server.run(hidden_activity);
    }
}

bool is_activity_open(ServerConnection& server) {
    return server.number("SELECT has_function_privilege('public', 'pg_lock_status()', 'EXECUTE')"
                         "::integer") != 0;
}

std::vector<std::string> open_databases_beside(ServerConnection& server) {
    std::vector<std::string> names;
    for (const auto& row :
         server.rows("SELECT datname FROM pg_database WHERE datallowconn AND datname <>"
                     " current_database() AND has_database_privilege('public', oid, 'CONNECT')"
                     " ORDER BY datname")) {
        names.push_back(row.at(0).value_or(""));
    }
    return names;
}

void expect_one_server(ServerConnection& server) {
    if (has_cells(server) && server.number("SELECT count(*) FROM macadam.cell_place") != 0) {
        throw InputError{fmt::format("{0}: other servers hold cells of it, but a crowd database "
                                     "works on one server only so far; 'macadam cells {0} --move "
                                     "CELL --to {0}' brings them back",
                                     server.address())};
    }
}

} // namespace macadam
