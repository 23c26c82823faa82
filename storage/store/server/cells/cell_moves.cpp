#include "storage/store/server/cells/cell_moves.hpp"

#include "estimator/common/error.hpp"
#include "storage/store/server/cells/cell_drives.hpp"
#include "storage/store/server/cells/cell_schema.hpp"
#include "storage/store/server/reader_rights.hpp"
#include "storage/store/server/server_locks.hpp"
#include "storage/store/server/server_tables.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>

namespace macadam {
namespace {

constexpr std::array moved_tables{"drive", "segment_state"};

/// Name of the server that holds a cell, if another one does.
std::optional<std::string> server_of(ServerConnection& front, std::int32_t cell) {
    const auto found =
        front.rows("SELECT server FROM macadam.cell_place WHERE cell = $1", {std::to_string(cell)});
    return found.empty() ? std::nullopt : found[0][0];
}

/// Runs statements that need tables alone once nobody reads them. Whoever begins to read waits two
/// seconds at most behind one who has read for long.
constexpr const char* between_readers = R"sql(
DO $$
DECLARE
    attempt integer := 0;
BEGIN
    LOOP
        BEGIN
            SET LOCAL lock_timeout = '2s';
            {}
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
END $$
)sql";

/// Removes tables of cells that moved away from here. They are not partitions, whose names end with
/// the cell.
constexpr const char* drop_left_tables = R"sql(
DO $$
DECLARE
    leaving text;
BEGIN
    SET LOCAL lock_timeout = '2s';
    FOR leaving IN SELECT relname FROM pg_class WHERE relnamespace = 'macadam'::regnamespace
                   AND relkind = 'r' AND relname ~ '^(drive|segment_state)_\d+_\d+$' LOOP
        BEGIN
            EXECUTE format('DROP TABLE macadam.%I', leaving);
        EXCEPTION WHEN lock_not_available THEN
            NULL; -- read at the moment: next time
        END;
    END LOOP;
END $$
)sql";

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
    const auto from = has_cells(front) ? server_of(front, cell) : std::nullopt;
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
    CellMove move{front, cell, number};
    to ? move.add_tables_on(*to) : move.add_tables_here();
    const auto rows = move.copy_rows();
    move.replace(from.has_value());
    move.note_place(to);
    all.commit();
    drop_unused_cell_tables(front);
    return rows;
}

std::vector<NextCellTables> prepare_cells(ServerConnection& front) {
    std::vector<NextCellTables> next;
    if (!has_cells(front)) {
        return next;
    }
    drop_unused_cell_tables(front);
    for (const auto& row :
         front.rows("SELECT cell, server, number FROM macadam.cell_place ORDER BY cell")) {
        const auto number = next_number(front);
        front.rows("SELECT macadam.add_cell_tables($1, $2, $3, $4)",
                   {row[1], row[0], std::to_string(number), row[2]});
        next.push_back({std::stoi(row[0].value_or("0")), number});
    }
    return next;
}

void switch_cells(ServerConnection& front, const std::vector<NextCellTables>& next) {
    std::string alterations;
    for (const auto& [cell, number] : next) {
        for (const auto* const table : moved_tables) {
            alterations +=
                fmt::format("ALTER FOREIGN TABLE macadam.{}_{} OPTIONS (SET table_name '{}');",
                            table,
                            cell,
                            cell_table(table, cell, number));
        }
    }
    if (!alterations.empty()) {
        front.run(fmt::format(fmt::runtime(between_readers), alterations));
    }
    for (const auto& [cell, number] : next) {
        front.rows("UPDATE macadam.cell_place SET number = $2 WHERE cell = $1",
                   {std::to_string(cell), std::to_string(number)});
    }
}

void drop_unused_cell_tables(ServerConnection& front) {
    if (!has_cells(front)) {
        return;
    }
    await_standby_of_front(front);
    await_standbys(front, cells_elsewhere(front)); // else what replaced them may go with a server
    try {
        front.rows("SELECT macadam.drop_cell_tables(name, ARRAY(SELECT number FROM"
                   " macadam.cell_place WHERE server = name)) FROM macadam_cells.address");
        front.run(drop_left_tables);
    } catch (const InputError& error) {
        throw ServerTrouble{fmt::format("{}; replaced rows are still there, and are removed by "
                                        "the next command of this kind",
                                        error.what())};
    }
}

} // namespace macadam
