#include "storage/store/server/importer/trip_rows.hpp"

#include "mapping/passes/chunk_trace.hpp"
#include "storage/postgres/copy_stream.hpp"
#include "storage/store/privacy/trip_names.hpp"
#include "storage/store/rows/known_trips.hpp"
#include "storage/store/rows/pass_writer.hpp"
#include "storage/store/server/cells/cell_drives.hpp"
#include "storage/store/server/drive_rows.hpp"
#include "storage/store/server/server_locks.hpp"
#include "storage/store/server/server_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>

namespace macadam {
namespace {

using Texts = std::vector<std::optional<std::string>>;

template <typename Integer>
std::optional<std::string> text_of(const std::optional<Integer>& number) {
    return number ? std::optional{std::to_string(*number)} : std::nullopt;
}

/// Trip of the call, with its row once it is written.
struct Candidate {
    const NewTrip* trip;
    std::size_t place; ///< in the call
    std::string car;   ///< pseudonym
    std::int64_t row = 0;
};

class TripWriting {
public:
    TripWriting(ServerConnection& server,
                CellDrives& cells,
                const StoreConnection& image,
                ImageRows& rows)
        : server_{&server}, cell_drives_{&cells}, image_{&image}, rows_{&rows} {}

    std::vector<bool> write(std::span<const NewTrip> trips, const PrivacyKey* key) {
        std::vector<bool> added(trips.size());
        auto candidates = candidates_of(trips, key);
        const auto cars = rows_of_cars(candidates);
        std::erase_if(candidates, [&](Candidate& candidate) { return !add_trip(candidate, cars); });
        for (const auto& candidate : candidates) {
            added[candidate.place] = true;
            collect_drives(candidate);
        }
        write_reasons(candidates);
        write_drives();
        write_events(candidates);
        mark_chunks();
        return added;
    }

private:
    /// Trips that were not forgotten, in the order of their hashes.
    std::vector<Candidate> candidates_of(std::span<const NewTrip> trips, const PrivacyKey* key) {
        std::vector<Candidate> candidates;
        for (std::size_t i = 0; i < trips.size(); ++i) {
            const auto mark = forgotten_mark(trips[i].trip->sha256);
            if (trips[i].readmit) {
                server_->rows("DELETE FROM macadam.forgotten WHERE mark = $1", {mark});
            } else if (!server_->rows("SELECT 1 FROM macadam.forgotten WHERE mark = $1", {mark})
                            .empty()) {
                continue;
            }
            const auto& id = trips[i].trip->vehicle_id;
            candidates.push_back(
                {&trips[i], i, key != nullptr ? key->pseudonym(id) : std::string{unknown_car}});
        }
        std::ranges::stable_sort(candidates, {}, [](const Candidate& candidate) {
            return std::string_view{candidate.trip->trip->sha256};
        });
        return candidates;
    }

    std::map<std::string, std::int64_t> rows_of_cars(const std::vector<Candidate>& candidates) {
        std::map<std::string, std::int64_t> cars;
        for (const auto& candidate : candidates) {
            if (!candidate.trip->trip->reference) {
                cars[candidate.car] = 0;
            }
        }
        for (auto& [car, row] : cars) {
            constexpr const char* select = "SELECT id FROM macadam.vehicle WHERE pseudonym = $1";
            auto found = server_->numbers(select, {car});
            if (found.empty()) {
                server_->rows("INSERT INTO macadam.vehicle (pseudonym) VALUES ($1)"
                              " ON CONFLICT (pseudonym) DO NOTHING",
                              {car});
                found = server_->numbers(select, {car}); // perhaps another worker's
            }
            row = found.at(0);
        }
        return cars;
    }

    /// \returns false if the trip is already stored. Its row is written all the same, so that the
    /// commit waits for the standby before anybody is told that it is.
    bool add_trip(Candidate& candidate, const std::map<std::string, std::int64_t>& cars) {
        const auto& trip = *candidate.trip->trip;
        Texts values{trip.sha256,
                     without_vehicle_id(trip.trip_id, trip.vehicle_id),
                     std::nullopt,
                     without_vehicle_id(trip.file_name, trip.vehicle_id),
                     text_of(trip.t0_utc_ms),
                     trip.vehicle_model,
                     trip.method,
                     std::to_string(trip.distance_mm),
                     std::to_string(trip.matched_mm),
                     std::to_string(trip.rows_read),
                     std::to_string(trip.rows_used),
                     std::nullopt,
                     std::nullopt,
                     std::to_string(trip.trimmed_mm)};
        if (trip.reference) {
            values[11] = std::to_string(trip.reference->relative_sd_ppm);
            values[12] = std::to_string(trip.reference->row_mm);
        } else {
            values[2] = std::to_string(cars.at(candidate.car));
        }
        // xmax is the transaction that changed or locked a row: 0 for one that was just inserted.
        const auto found = server_->numbers(
            "INSERT INTO macadam.trip AS trip (sha256, trip_id, vehicle, file_name, t0_utc_ms,"
            " vehicle_model, method, distance_mm, matched_mm, rows_read, rows_used, reference_ppm,"
            " reference_row_mm, trimmed_mm) VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11,"
            " $12, $13, $14)"
            " ON CONFLICT (sha256) DO UPDATE SET trip_id = trip.trip_id"
            " RETURNING id, (trip.xmax = 0)::integer",
            values);
        candidate.row = found.at(0);
        return found.at(1) != 0;
    }

    void collect_drives(const Candidate& candidate) {
        const double length_m = image_->settings.segment_length_m;
        for (const auto& pass : candidate.trip->passes) {
            const auto segment = rows_->row_of(pass.segment);
            const auto chunk = rows_->row_of(chunk_of(pass.segment, length_m));
            const auto offset = static_cast<std::uint32_t>(segment - chunk);
            drives_[{chunk, candidate.row, drive_number(pass)}].passes.push_back({offset, pass});
            chunks_.insert(chunk);
        }
        for (const auto& trace : candidate.trip->traces) {
            const auto chunk = rows_->row_of(trace.chunk);
            drives_[{chunk, candidate.row, trace.drive}].trace = drive_trace_of(trace);
            chunks_.insert(chunk); // it can also shift others where its trip has no pass
        }
    }

    void write_reasons(const std::vector<Candidate>& candidates) {
        if (std::ranges::all_of(candidates, [](const Candidate& candidate) {
                return candidate.trip->trip->row_reasons.empty();
            })) {
            return;
        }
        CopyWriter writer{*server_, copy_target(server_table("row_reason")), 3};
        for (const auto& candidate : candidates) {
            for (const auto& [reason, rows] : candidate.trip->trip->row_reasons) {
                writer.add(candidate.row, reason, static_cast<std::int64_t>(rows));
            }
        }
        writer.finish();
    }

    void write_drives() {
        if (drives_.empty()) {
            return;
        }
        std::set<std::int32_t> cells;
        std::set<std::int64_t> trips;
        for (const auto& [name, drive] : drives_) {
            cells.insert(rows_->place_of(name.chunk).cell);
            trips.insert(name.trip);
        }
        share_cells(*server_, cells);
        const bool elsewhere = are_elsewhere(*server_, cells);
        const auto& table = server_table("drive");
        CopyWriter writer{*server_,
                          elsewhere ? cell_drives_->place() : copy_target(table),
                          static_cast<int>(table.columns.size())};
        for (auto& [name, drive] : drives_) {
            write_drive(writer, rows_->place_of(name.chunk).cell, name, std::move(drive));
        }
        writer.finish();
        if (elsewhere) {
            cell_drives_->put(std::vector<std::int64_t>{trips.begin(), trips.end()});
        }
    }

    void write_events(const std::vector<Candidate>& candidates) {
        std::vector<std::string> searched;
        bool has_events = false;
        for (const auto& candidate : candidates) {
            if (candidate.trip->events) {
                searched.push_back(std::to_string(candidate.row));
                has_events = has_events || !candidate.trip->events->empty();
            }
        }
        if (!searched.empty()) {
            server_->rows("INSERT INTO macadam.event_search SELECT unnest($1::bigint[])",
                          {fmt::format("{{{}}}", fmt::join(searched, ","))});
        }
        if (!has_events) {
            return;
        }
        CopyWriter writer{*server_, copy_target(server_table("event")), 11};
        for (const auto& candidate : candidates) {
            const auto events = candidate.trip->events.value_or(std::span<const PassEvent>{});
            for (const auto& [number, event] : numbered_events(events)) {
                writer.add(rows_->row_of(event.segment),
                           candidate.row,
                           std::int64_t{event.occurrence},
                           number,
                           static_cast<std::int64_t>(event.kind),
                           static_cast<std::int64_t>(event.track),
                           event.at_mm,
                           std::int64_t{event.place_sd_mm},
                           std::int64_t{event.size_um},
                           std::int64_t{event.sd_um},
                           std::int64_t{event.length_mm});
            }
        }
        writer.finish();
    }

    /// DO NOTHING would not wait for a fuser that removes the mark, and the wake-up would be lost.
    void mark_chunks() {
        if (!chunks_.empty()) {
            server_->rows("INSERT INTO macadam.chunk_dirty (chunk, since_ms)"
                          " SELECT chunk, (extract(epoch FROM clock_timestamp()) * 1000)::bigint"
                          " FROM unnest($1::bigint[]) AS chunk ORDER BY chunk"
                          " ON CONFLICT (chunk) DO UPDATE SET marks = chunk_dirty.marks + 1",
                          {fmt::format("{{{}}}", fmt::join(chunks_, ","))});
        }
    }

    ServerConnection* server_;
    CellDrives* cell_drives_;
    const StoreConnection* image_;
    ImageRows* rows_;
    std::map<DriveName, ChunkDrive> drives_;
    std::set<std::int64_t> chunks_;
};

} // namespace

std::vector<bool> write_trips(ServerConnection& server,
                              CellDrives& cells,
                              const StoreConnection& image,
                              ImageRows& rows,
                              const PrivacyKey* key,
                              std::span<const NewTrip> trips) {
    return TripWriting{server, cells, image, rows}.write(trips, key);
}

} // namespace macadam
