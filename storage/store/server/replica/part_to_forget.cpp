#include "storage/store/server/replica/part_to_forget.hpp"

#include "storage/postgres/server_array.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/privacy/trip_names.hpp"
#include "storage/store/server/user_files.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

std::optional<PrivacyKey> key_of(ServerConnection& server) {
    const auto ids = server.rows("SELECT value FROM macadam.meta WHERE key = 'key_id'");
    return ids.empty() ? std::nullopt : read_key(server_key_file(ids[0][0].value_or("")));
}

std::vector<std::int64_t> trips_by_name(ServerConnection& server,
                                        const std::vector<std::string>& names) {
    return server.numbers("SELECT id FROM macadam.trip WHERE trip_id = ANY($1::text[])"
                          " OR file_name = ANY($1::text[]) OR sha256 = ANY($1::text[])",
                          {array_of(names)});
}

/// Trips by names that contain the id of their car, which is not stored.
std::vector<std::int64_t> trips_by_full_name(ServerConnection& server,
                                             const PrivacyKey& key,
                                             const std::vector<std::string>& names) {
    constexpr std::size_t longest = 255; // of a file name
    std::vector<std::string> cars, kept;
    for (const auto& name : names) {
        for (auto& reading : readings_of_name(std::string_view{name}.substr(0, longest))) {
            cars.push_back(key.pseudonym(reading.vehicle_id));
            kept.push_back(std::move(reading.kept));
        }
    }
    return server.numbers(
        "SELECT trip.id FROM unnest($1::text[], $2::text[]) AS reading (car, kept)"
        " JOIN macadam.vehicle ON pseudonym = car"
        " JOIN macadam.trip ON trip.vehicle = vehicle.id"
        " AND (trip_id = kept OR file_name = kept)",
        {array_of(cars), array_of(kept)});
}

std::vector<std::int64_t> trips_of_cars(ServerConnection& server,
                                        const std::optional<PrivacyKey>& key,
                                        const std::vector<std::string>& vehicles) {
    auto names = vehicles;
    for (const auto& vehicle : vehicles) {
        if (key) {
            names.push_back(key->pseudonym(vehicle));
        }
    }
    return server.numbers("SELECT trip.id FROM macadam.trip JOIN macadam.vehicle"
                          " ON vehicle.id = trip.vehicle WHERE pseudonym = ANY($1::text[])",
                          {array_of(names)});
}

std::vector<std::int64_t> leaving_trips(ServerConnection& server, const ForgetRequest& request) {
    const auto key = key_of(server);
    auto trips = trips_of_cars(server, key, request.vehicles);
    const auto add = [&](const std::vector<std::int64_t>& more) {
        trips.insert(trips.end(), more.begin(), more.end());
    };
    add(trips_by_name(server, request.trips));
    if (key) {
        add(trips_by_full_name(server, *key, request.trips));
    }
    std::ranges::sort(trips);
    trips.erase(std::ranges::unique(trips).begin(), trips.end());
    return trips;
}

} // namespace

std::optional<DatabasePart> part_to_forget(ServerConnection& server, const ForgetRequest& request) {
    const auto trips = leaving_trips(server, request);
    const auto leaving = array_of(trips);
    if (server
            .numbers("SELECT count(*) FROM macadam.trip WHERE id = ANY($1::bigint[])"
                     " AND calibrates <> 0",
                     {leaving})
            .at(0) != 0) {
        return std::nullopt;
    }
    DatabasePart part{
        .chunks = chunks_in(server.numbers("SELECT DISTINCT cell, chunk FROM macadam.drive"
                                           " WHERE trip = ANY($1::bigint[]) ORDER BY cell, chunk",
                                           {leaving})),
        .trips = server.numbers("SELECT max(id) FROM macadam.trip WHERE id <> ALL($1::bigint[])"
                                " AND vehicle IN (SELECT vehicle FROM macadam.trip"
                                " WHERE id = ANY($1::bigint[])) GROUP BY vehicle"
                                " UNION SELECT max(id) FROM macadam.trip"
                                " WHERE id <> ALL($1::bigint[]) HAVING max(id) IS NOT NULL",
                                {leaving})};
    part.trips.insert(part.trips.end(), trips.begin(), trips.end());
    return part;
}

} // namespace macadam
