#include "storage/store/server/cells/cell_drives.hpp"

#include "estimator/common/error.hpp"
#include "storage/store/server/server_locks.hpp"
#include "storage/store/server/server_tables.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <vector>

namespace macadam {
namespace {

template <typename Numbers>
std::string array_of(const Numbers& numbers) {
    return fmt::format("{{{}}}", fmt::join(numbers, ","));
}

/// Notes the trips at once, whatever becomes of the transaction, and holds the notes in it.
void note_trips(ServerConnection& front, const std::string& trips, std::size_t count) {
    ServerConnection{front.address()}.rows(
        "INSERT INTO macadam.unfinished (trip) SELECT unnest($1::bigint[])", {trips});
    if (front
            .rows("SELECT trip FROM macadam.unfinished WHERE trip = ANY($1::bigint[]) FOR UPDATE",
                  {trips})
            .size() != count) {
        throw ServerTrouble{fmt::format("{}: removed the trips before their passes were written; "
                                        "run the command again",
                                        front.address())};
    }
}

/// Sends a call for each cell.
void send_drives(ServerConnection& front) {
    std::string arrays;
    for (const auto& column : server_table("drive").columns) {
        arrays += fmt::format(", array_agg(new_drive.{})", column.name);
    }
    static_cast<void>(front.take_warnings());
    std::vector<std::int64_t> counts;
    try {
        counts = front.numbers(fmt::format(
            "SELECT macadam.put_drives(server, 'drive_' || cell || '_' || number{}), count(*)"
            " FROM pg_temp.new_drive JOIN macadam.cell_place USING (cell)"
            " GROUP BY server, cell, number",
            arrays));
    } catch (const InputError& error) {
        throw ServerTrouble{error.what()};
    }
    for (std::size_t i = 0; i + 1 < counts.size(); i += 2) {
        if (counts[i] != counts[i + 1]) { // numbers of trips are used once
            throw InputError{fmt::format("{}: a server of its cells has drives of trips that are "
                                         "new here; were both restored to one moment?",
                                         front.address())};
        }
    }
    if (const auto warnings = front.take_warnings(); !warnings.empty()) {
        throw ServerTrouble{fmt::format("{}: a server of its cells warns: {}; run the command "
                                        "again",
                                        front.address(),
                                        warnings.front())};
    }
}

} // namespace

bool are_elsewhere(ServerConnection& front, const std::set<std::int32_t>& cells) {
    return has_cells(front) &&
           !front
                .rows("SELECT FROM macadam.cell_place WHERE cell = ANY($1::integer[]) LIMIT 1",
                      {array_of(cells)})
                .empty();
}

std::string place_for_drives(ServerConnection& front) {
    const auto& drive = server_table("drive");
    front.run(fmt::format("CREATE TEMP TABLE new_drive ON COMMIT DROP AS"
                          " SELECT {} FROM macadam.drive WHERE false",
                          column_list(drive)));
    return fmt::format("pg_temp.new_drive ({})", column_list(drive));
}

void put_drives(ServerConnection& front, std::span<const std::int64_t> trips) {
    const auto all = array_of(trips);
    note_trips(front, all, trips.size());
    send_drives(front);
    front.run(fmt::format("INSERT INTO macadam.drive ({0}) SELECT {0} FROM pg_temp.new_drive"
                          " WHERE cell NOT IN (SELECT cell FROM macadam.cell_place)",
                          column_list(server_table("drive"))));
    front.rows("DELETE FROM macadam.unfinished WHERE trip = ANY($1::bigint[])", {all});
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
        std::set<std::int32_t> cells;
        for (const auto cell : front.numbers("SELECT cell FROM macadam.cell_place")) {
            cells.insert(static_cast<std::int32_t>(cell));
        }
        share_cells(front, cells);
        front.rows("DELETE FROM macadam.drive WHERE trip = ANY($1::bigint[])"
                   " AND NOT EXISTS (SELECT FROM macadam.trip WHERE trip.id = drive.trip)",
                   {array_of(trips)});
        front.rows("DELETE FROM macadam.unfinished WHERE trip = ANY($1::bigint[])",
                   {array_of(trips)});
    }
    all.commit();
}

} // namespace macadam
