#include "storage/store/reader/trip_list.hpp"

#include "storage/sqlite/sqlite.hpp"
#include "storage/store/rows/segment_row.hpp"

namespace macadam {

std::vector<StoredTrip> stored_trips(const std::filesystem::path& store) {
    Database database{store, Database::Access::read};
    auto select = database.prepare(
        "SELECT sha256, vehicle.pseudonym, vehicle_model, method, t0_utc_ms, distance_mm,"
        " matched_mm, (SELECT count(*) FROM pass WHERE pass.trip = trip.id), rows_read, rows_used"
        " FROM trip JOIN vehicle ON vehicle.id = trip.vehicle ORDER BY trip.id DESC");
    std::vector<StoredTrip> trips;
    while (select.step()) {
        trips.push_back({.sha256 = select.text(0),
                         .vehicle = select.text(1),
                         .vehicle_model = select.text(2),
                         .method = select.text(3),
                         .start_ms = known_utc_ms(select, 4),
                         .driven_mm = select.integer(5),
                         .matched_mm = select.integer(6),
                         .passes = select.integer(7),
                         .rows_read = select.integer(8),
                         .rows_used = select.integer(9)});
    }
    return trips;
}

} // namespace macadam
