#include "storage/store/server/cells/cell_drives.hpp"

#include "estimator/common/error.hpp"
#include "storage/postgres/idle_limit.hpp"
#include "storage/postgres/server_array.hpp"
#include "storage/store/server/server_locks.hpp"
#include "storage/store/server/server_tables.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <vector>

namespace macadam {
namespace {

/// Runs a statement that calls functions of PL/Proxy, whose commits other servers may warn of.
std::vector<std::int64_t> called(ServerConnection& front,
                                 const std::string& sql,
                                 const std::vector<std::optional<std::string>>& values = {}) {
    static_cast<void>(front.take_warnings());
    std::vector<std::int64_t> numbers;
    try {
        numbers = front.numbers(sql, values);
    } catch (const InputError& error) {
        throw ServerTrouble{error.what()};
    }
    if (const auto warnings = front.take_warnings(); !warnings.empty()) {
        throw ServerTrouble{fmt::format("{}: a server of its cells warns: {}; run the command "
                                        "again",
                                        front.address(),
                                        warnings.front())};
    }
    return numbers;
}

/// Sends a call for each cell.
void send_drives(ServerConnection& front) {
    std::string arrays;
    for (const auto& column : server_table("drive").columns) {
        arrays += fmt::format(", array_agg(new_drive.{})", column.name);
    }
    const auto counts =
        called(front,
               fmt::format("SELECT macadam.put_drives(server, 'drive_' || cell || '_' || number{}),"
                           " count(*) FROM pg_temp.new_drive JOIN macadam.cell_place USING (cell)"
                           " GROUP BY server, cell, number",
                           arrays));
    for (std::size_t i = 0; i + 1 < counts.size(); i += 2) {
        if (counts[i] != counts[i + 1]) { // numbers of trips are used once
            throw InputError{fmt::format("{}: a server of its cells has drives of trips that are "
                                         "new here; were both restored to one moment?",
                                         front.address())};
        }
    }
}

} // namespace

void await_standbys(ServerConnection& front, const std::set<std::int32_t>& cells) {
    if (front.number("SELECT (to_regprocedure('macadam.await_standby(text)') IS NOT NULL)"
                     "::integer") == 0) {
        return;
    }
    called(front,
           "SELECT count(macadam.await_standby(server)) FROM (SELECT DISTINCT server"
           " FROM macadam.cell_place WHERE cell = ANY($1::integer[])) AS places",
           {array_of(cells)});
}

std::set<std::int32_t> cells_elsewhere(ServerConnection& front) {
    std::set<std::int32_t> cells;
    for (const auto cell : front.numbers("SELECT cell FROM macadam.cell_place")) {
        cells.insert(static_cast<std::int32_t>(cell));
    }
    return cells;
}

bool are_elsewhere(ServerConnection& front, const std::set<std::int32_t>& cells) {
    return has_cells(front) &&
           !front
                .rows("SELECT FROM macadam.cell_place WHERE cell = ANY($1::integer[]) LIMIT 1",
                      {array_of(cells)})
                .empty();
}

std::string CellDrives::place() {
    front_->run("CREATE TEMP TABLE IF NOT EXISTS new_drive (LIKE macadam.drive)"
                " ON COMMIT DELETE ROWS");
    return fmt::format("pg_temp.new_drive ({})", column_list(server_table("drive")));
}

void CellDrives::put(std::span<const std::int64_t> trips) {
    const auto all = array_of(trips);
    note(all, trips.size());
    send_drives(*front_);
    front_->run(fmt::format("INSERT INTO macadam.drive ({0}) SELECT {0} FROM pg_temp.new_drive"
                            " WHERE cell NOT IN (SELECT cell FROM macadam.cell_place)",
                            column_list(server_table("drive"))));
    front_->rows("DELETE FROM macadam.unfinished WHERE trip = ANY($1::bigint[])", {all});
}

/// Notes the trips at once, whatever becomes of the transaction, and holds the notes in it.
void CellDrives::note(const std::string& trips, std::size_t count) {
    if (!notes_) {
        notes_.emplace(front_->address());
    }
    const auto limit = set_idle_limit(*front_, "0"); // a lost standby holds the note up
    try {
        ServerTransaction one{*notes_};
        notes_->rows("INSERT INTO macadam.unfinished (trip) SELECT unnest($1::bigint[])", {trips});
        one.commit(); // the standby then has their numbers, too, which are not given again
    } catch (const InputError&) {
        notes_.reset(); // perhaps broken
        throw;
    }
    set_idle_limit(*front_, limit);
    if (front_
            ->rows("SELECT trip FROM macadam.unfinished WHERE trip = ANY($1::bigint[]) FOR UPDATE",
                   {trips})
            .size() != count) {
        throw ServerTrouble{fmt::format("{}: removed the trips before their passes were written; "
                                        "run the command again",
                                        front_->address())};
    }
}

void remove_unfinished(ServerConnection& front) {
    if (!has_cells(front)) {
        return;
    }
    ServerTransaction all{front};
    share_database(front);
    const auto trips = front.numbers("SELECT trip FROM macadam.unfinished"
                                     " WHERE at < now() - interval '10 minutes'"
                                     " ORDER BY trip FOR UPDATE SKIP LOCKED");
    if (!trips.empty()) {
        share_cells(front, cells_elsewhere(front));
        front.rows("DELETE FROM macadam.drive WHERE trip = ANY($1::bigint[])"
                   " AND NOT EXISTS (SELECT FROM macadam.trip WHERE trip.id = drive.trip)",
                   {array_of(trips)});
        front.rows("DELETE FROM macadam.unfinished WHERE trip = ANY($1::bigint[])",
                   {array_of(trips)});
    }
    all.commit();
}

} // namespace macadam
