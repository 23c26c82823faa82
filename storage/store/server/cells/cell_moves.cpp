#include "storage/store/server/cells/cell_moves.hpp"

#include "estimator/common/error.hpp"
#include "storage/postgres/role_grants.hpp"
#include "storage/postgres/server_array.hpp"
#include "storage/store/server/cells/cell_drives.hpp"
#include "storage/store/server/cells/cell_schema.hpp"
#include "storage/store/server/reader_rights.hpp"
#include "storage/store/server/server_locks.hpp"
#include "storage/store/server/server_tables.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string_view>

namespace macadam {
namespace {

constexpr std::array moved_tables{"drive", "segment_state"};

/// Name of the server that holds a cell, if another one does.
std::optional<std::string> server_of(ServerConnection& front, std::int32_t cell) {
    const auto found =
        front.rows("SELECT server FROM macadam.cell_place WHERE cell = $1", {std::to_string(cell)});
    return found.empty() ? std::nullopt : found[0][0];
}

/// On the front, as its owner, with whose rights operators call them.
constexpr const char* operator_functions = R"sql(
CREATE OR REPLACE FUNCTION macadam.prepare_cell(cell integer) RETURNS bigint
LANGUAGE plpgsql SECURITY DEFINER SET search_path = pg_catalog, pg_temp AS $$
DECLARE
    place record;
    next_number bigint := nextval('macadam.cell_number');
BEGIN
    SELECT cell_place.server, cell_place.number INTO STRICT place
    FROM macadam.cell_place WHERE cell_place.cell = prepare_cell.cell;
    PERFORM macadam.add_cell_tables(place.server, prepare_cell.cell, next_number, place.number);
    RETURN next_number;
END $$;

-- Within the transaction that fills the tables of a cell: what its server lost, it lost with this.
CREATE OR REPLACE FUNCTION macadam.note_filled(cell integer) RETURNS void
LANGUAGE plpgsql SET search_path = pg_catalog, pg_temp AS $$
DECLARE
    place record;
BEGIN
    FOR place IN SELECT to_regclass('macadam.filled_' || server) AS filled, number
                 FROM macadam.cell_place WHERE cell_place.cell = note_filled.cell LOOP
        IF place.filled IS NOT NULL THEN
            EXECUTE format('INSERT INTO %s VALUES ($1)', place.filled) USING place.number;
        END IF;
    END LOOP;
END $$;

CREATE OR REPLACE FUNCTION macadam.lost_cells(cells integer[]) RETURNS SETOF integer
LANGUAGE plpgsql SECURITY DEFINER SET search_path = pg_catalog, pg_temp AS $$
DECLARE
    place record;
    is_filled boolean;
BEGIN
    FOR place IN SELECT cell, number, to_regclass('macadam.filled_' || server) AS filled
                 FROM macadam.cell_place WHERE cell = ANY (cells) ORDER BY cell LOOP
        IF place.filled IS NOT NULL THEN
            EXECUTE format('SELECT EXISTS (SELECT FROM %s WHERE number = $1)', place.filled)
            INTO is_filled USING place.number;
            IF NOT is_filled THEN
                RETURN NEXT place.cell;
            END IF;
        END IF;
    END LOOP;
END $$;

-- Whoever begins to read waits two seconds at most behind one who has read for long.
CREATE OR REPLACE FUNCTION macadam.switch_cells(cells integer[], numbers bigint[]) RETURNS void
LANGUAGE plpgsql SECURITY DEFINER SET search_path = pg_catalog, pg_temp AS $$
DECLARE
    attempt integer := 0;
    next_one record;
    parent text;
BEGIN
    LOOP
        BEGIN
            SET LOCAL lock_timeout = '2s';
            FOR next_one IN SELECT * FROM unnest(cells, numbers) AS next (cell, number) LOOP
                FOREACH parent IN ARRAY ARRAY['drive', 'segment_state'] LOOP
                    EXECUTE format('ALTER FOREIGN TABLE macadam.%I OPTIONS (SET table_name %L)',
                                   parent || '_' || next_one.cell,
                                   parent || '_' || next_one.cell || '_' || next_one.number);
                END LOOP;
            END LOOP;
            EXIT;
        EXCEPTION WHEN lock_not_available THEN
            attempt := attempt + 1;
            IF attempt = 40 THEN
                RAISE EXCEPTION 'cells are being read; nothing was written, run the command again';
            END IF;
        END;
        PERFORM pg_sleep(0.5);
    END LOOP;
    SET LOCAL lock_timeout TO DEFAULT;
    UPDATE macadam.cell_place SET number = next.number
    FROM unnest(cells, numbers) AS next (cell, number) WHERE cell_place.cell = next.cell;
    PERFORM macadam.note_filled(cell) FROM unnest(cells) AS cell;
END $$;

-- On the front, partitions have names that end with the cell.
CREATE OR REPLACE FUNCTION macadam.drop_unused_cell_tables() RETURNS void
LANGUAGE plpgsql SECURITY DEFINER SET search_path = pg_catalog, pg_temp SET lock_timeout = '2s' AS $$
DECLARE
    leaving text;
BEGIN
    PERFORM macadam.drop_cell_tables(name, ARRAY(SELECT number FROM macadam.cell_place
                                                 WHERE server = name))
    FROM macadam_cells.address;
    FOR leaving IN SELECT relname FROM pg_class WHERE relnamespace = 'macadam'::regnamespace
                   AND relkind = 'r' AND relname ~ '^(drive|segment_state)_\d+_\d+$' LOOP
        BEGIN
            EXECUTE format('DROP TABLE macadam.%I', leaving);
        EXCEPTION WHEN lock_not_available THEN
            NULL; -- read at the moment: next time
        END;
    END LOOP;
END $$;

COMMENT ON FUNCTION macadam.prepare_cell IS 'Copies the tables of a cell on its server, under the number that it returns';
COMMENT ON FUNCTION macadam.note_filled IS 'Notes on the server of a cell that its tables are filled';
COMMENT ON FUNCTION macadam.lost_cells IS 'Those of these cells whose server lost the rows that it got, as in a failover';
COMMENT ON FUNCTION macadam.switch_cells IS 'Lets cells have the tables of these numbers';
COMMENT ON FUNCTION macadam.drop_unused_cell_tables IS 'Removes tables of cells, here and on other servers, that were replaced';
REVOKE ALL ON FUNCTION macadam.prepare_cell, macadam.note_filled, macadam.lost_cells, macadam.switch_cells, macadam.drop_unused_cell_tables
FROM PUBLIC;
)sql";

/// Gives operators the functions above, which a new front lacks, and one of an earlier version.
void add_operator_functions(ServerConnection& front) {
    if (front.number("SELECT (to_regprocedure('macadam.drop_unused_cell_tables()') IS NOT NULL)"
                     "::integer") != 0) {
        return;
    }
    if (front.number("SELECT pg_has_role(nspowner, 'USAGE')::integer FROM pg_namespace"
                     " WHERE nspname = 'macadam'") == 0) {
        throw InputError{fmt::format("{0}: its cells were moved by an earlier version, which let "
                                     "the owner alone change them; once the owner ran 'macadam "
                                     "cells {0} --move CELL --to ADDRESS', even to where the cell "
                                     "is, operators may, too",
                                     front.address())};
    }
    ServerTransaction all{front};
    act_as_owner(front);
    front.run(operator_functions +
              granting("EXECUTE ON FUNCTION macadam.prepare_cell, macadam.lost_cells,"
                       " macadam.switch_cells, macadam.drop_unused_cell_tables",
                       {std::string_view{"macadam_operator"}}));
    all.commit();
}

std::int64_t next_number(ServerConnection& front) {
    return front.number("SELECT nextval('macadam.cell_number')");
}

/// Number and sum of hashes of rows.
std::vector<std::optional<std::string>> sums_of(ServerConnection& front, const std::string& table) {
    return front
        .rows(fmt::format("SELECT count(*), sum(hashtextextended(rows::text, 0)::numeric)"
                          " FROM macadam.{} AS rows",
                          table))
        .at(0);
}

/// Move of one cell, within a transaction of the front.
class CellMove {
public:
    CellMove(ServerConnection& front, std::int32_t cell, std::int64_t number)
        : front_{&front}, cell_{cell}, number_{number} {}

    /// Makes new tables known here under the names that they have there.
    void add_tables_on(const std::string& server) {
        front_->run(fmt::format("IMPORT FOREIGN SCHEMA macadam LIMIT TO ({}, {}) FROM SERVER {}"
                                " INTO macadam",
                                next("drive"),
                                next("segment_state"),
                                server));
        for (const auto* const table : moved_tables) {
            front_->run(fmt::format("COMMENT ON FOREIGN TABLE macadam.{} IS"
                                    " 'Rows of table {} in map tile {}, on another server'",
                                    next(table),
                                    table,
                                    cell_));
        }
    }

    void add_tables_here() {
        for (const auto* const table : moved_tables) {
            front_->run(fmt::format("CREATE TABLE macadam.{0} (LIKE macadam.{1} INCLUDING ALL);"
                                    "ALTER TABLE macadam.{0} ADD {2};"
                                    "COMMENT ON TABLE macadam.{0} IS"
                                    " 'Rows of table {1} in map tile {3}'",
                                    next(table),
                                    table,
                                    server_table(table).constraints,
                                    cell_));
        }
    }

    std::int64_t copy_rows() {
        std::int64_t rows = 0;
        for (const auto* const table : moved_tables) {
            front_->run(fmt::format("INSERT INTO macadam.{0} ({2}) SELECT {2} FROM macadam.{1}",
                                    next(table),
                                    present(table),
                                    column_list(server_table(table))));
            const auto sums = sums_of(*front_, present(table));
            if (sums_of(*front_, next(table)) != sums) {
                throw InputError{fmt::format(
                    "{}: the copy of cell {} differs; it was not moved", front_->address(), cell_)};
            }
            rows += std::stoll(sums.at(0).value_or("0"));
        }
        return rows;
    }

    /// Puts the new tables in the places of the present ones, of which those here stay until
    /// drop_unused_cell_tables(). \param was_elsewhere  of the present ones
    void replace(bool was_elsewhere) {
        const auto left = next_number(*front_);
        front_->run("LOCK TABLE ONLY macadam.drive IN ACCESS EXCLUSIVE MODE;"
                    "LOCK TABLE ONLY macadam.segment_state IN ACCESS EXCLUSIVE MODE");
        for (const auto* const table : moved_tables) {
            front_->run(fmt::format(
                "ALTER TABLE macadam.{0} DETACH PARTITION macadam.{1};"
                "{2};"
                "ALTER TABLE macadam.{3} RENAME TO {1};"
                "ALTER TABLE macadam.{0} ATTACH PARTITION macadam.{1}"
                " FOR VALUES IN ({4})",
                table,
                present(table),
                was_elsewhere ? fmt::format("DROP FOREIGN TABLE macadam.{}", present(table))
                              : fmt::format("ALTER TABLE macadam.{} RENAME TO {}",
                                            present(table),
                                            cell_table(table, cell_, left)),
                next(table),
                cell_));
        }
    }

    void note_place(const std::optional<std::string>& server) {
        const auto cell = std::to_string(cell_);
        front_->rows("DELETE FROM macadam.cell_place WHERE cell = $1", {cell});
        if (server) {
            front_->rows("INSERT INTO macadam.cell_place VALUES ($1, $2, $3)",
                         {cell, *server, std::to_string(number_)});
            front_->rows("SELECT macadam.note_filled($1)", {cell});
        }
    }

private:
    std::string present(const char* table) const { return fmt::format("{}_{}", table, cell_); }
    std::string next(const char* table) const { return cell_table(table, cell_, number_); }

    ServerConnection* front_;
    std::int32_t cell_;
    std::int64_t number_;
};

/// Commits on the front, which ends, or throws, as commits before it did that waited for a standby.
void await_standby_of_front(ServerConnection& front) {
    ServerTransaction one{front};
    front.rows("SELECT pg_logical_emit_message(true, 'macadam', '')");
    one.commit();
}

/// Refuses to go on if a server lost rows of these cells that the front counts on, whatever its
/// standbys have: it failed, and a standby took over that lacked them.
void expect_no_lost_cells(ServerConnection& front, const std::set<std::int32_t>& cells) {
    const auto lost = front.numbers("SELECT macadam.lost_cells($1)", {array_of(cells)});
    if (!lost.empty()) {
        throw InputError{fmt::format("{}: another server lost the rows that it got of cell {}, as "
                                     "in a failover without its standby; nothing is removed, rows "
                                     "that were replaced are still there (docs/cluster.md, "
                                     "'Several clusters')",
                                     front.address(),
                                     fmt::join(lost, ", "))};
    }
}

void expect_cell(ServerConnection& front, std::int32_t cell) {
    if (front.rows("SELECT FROM macadam.segment WHERE cell = $1 LIMIT 1", {std::to_string(cell)})
            .empty()) {
        throw InputError{fmt::format(
            "{0}: has no cell {1}; 'macadam cells {0}' lists them", front.address(), cell)};
    }
}

} // namespace

std::vector<MapCell> cells_of(ServerConnection& front) {
    const bool has_places = has_cells(front);
    std::vector<MapCell> cells;
    for (const auto& row : front.rows(fmt::format(
             "SELECT cell, count(*), {} FROM macadam.segment GROUP BY cell ORDER BY cell",
             has_places ? "(SELECT macadam_cells.connection_of(server) FROM macadam.cell_place"
                          " WHERE cell_place.cell = segment.cell)"
                        : "NULL"))) {
        cells.push_back({std::stoi(row[0].value_or("0")),
                         std::stoll(row[1].value_or("0")),
                         row[2].value_or("")});
    }
    return cells;
}

std::int64_t move_cell(ServerConnection& front, std::int32_t cell, const std::string& address) {
    expect_cell(front, cell);
    if (address != front.address() && is_crowd(front)) {
        throw InputError{fmt::format("{}: is a crowd database, which works on one server only so "
                                     "far: its cells stay",
                                     front.address())};
    }
    take_cell_places(front);
    std::optional<std::string> to;
    if (address != front.address()) {
        auto server = cell_server_at(front, address);
        to = (server ? *server : add_cell_server(front, address)).name;
    }
    std::optional<std::string> from;
    if (has_cells(front)) {
        add_operator_functions(front);
        from = server_of(front, cell);
    }
    if (from == to) {
        drop_unused_cell_tables(front); // an earlier move may have been in doubt
        return 0;
    }
    const auto number = next_number(front);
    if (to) {
        front.rows("SELECT macadam.add_cell_tables($1, $2, $3, NULL)",
                   {*to, std::to_string(cell), std::to_string(number)});
    }
    ServerTransaction all{front};
    take_cell(front, cell);
    act_as_owner(front);
    expect_no_lost_cells(front, {cell}); // at the moment that is copied
    CellMove move{front, cell, number};
    to ? move.add_tables_on(*to) : move.add_tables_here();
    const auto rows = move.copy_rows();
    move.replace(from.has_value());
    move.note_place(to);
    all.commit();
    drop_unused_cell_tables(front);
    return rows;
}

std::vector<NextCellTables> prepare_cells(ServerConnection& front,
                                          const std::optional<std::set<std::int32_t>>& changing) {
    std::vector<NextCellTables> next;
    if (!has_cells(front)) {
        return next;
    }
    add_operator_functions(front);
    drop_unused_cell_tables(front);
    for (const auto cell : cells_elsewhere(front)) {
        if (!changing || changing->contains(cell)) {
            next.push_back(
                {cell,
                 front.numbers("SELECT macadam.prepare_cell($1)", {std::to_string(cell)}).at(0)});
        }
    }
    return next;
}

void switch_cells(ServerConnection& front, const std::vector<NextCellTables>& next) {
    if (next.empty()) {
        return;
    }
    std::vector<std::int32_t> cells;
    std::vector<std::int64_t> numbers;
    for (const auto& [cell, number] : next) {
        cells.push_back(cell);
        numbers.push_back(number);
    }
    front.rows("SELECT macadam.switch_cells($1, $2)", {array_of(cells), array_of(numbers)});
}

void drop_unused_cell_tables(ServerConnection& front) {
    if (!has_cells(front)) {
        return;
    }
    await_standby_of_front(front);
    await_standbys(front, cells_elsewhere(front)); // else what replaced them may go with a server
    expect_no_lost_cells(front, cells_elsewhere(front));
    try {
        front.rows("SELECT macadam.drop_unused_cell_tables()");
    } catch (const InputError& error) {
        throw ServerTrouble{fmt::format("{}; replaced rows are still there, and are removed by "
                                        "the next command of this kind",
                                        error.what())};
    }
}

} // namespace macadam
