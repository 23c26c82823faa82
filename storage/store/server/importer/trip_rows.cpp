#include "storage/store/server/importer/trip_rows.hpp"

#include "estimator/common/exact_number.hpp"
#include "mapping/passes/chunk_trace.hpp"
#include "storage/postgres/copy_stream.hpp"
#include "storage/postgres/server_array.hpp"
#include "storage/store/privacy/trip_names.hpp"
#include "storage/store/rows/known_trips.hpp"
#include "storage/store/rows/pass_writer.hpp"
#include "storage/store/server/cells/cell_drives.hpp"
#include "storage/store/server/drive_rows.hpp"
#include "storage/store/server/server_locks.hpp"
#include "storage/store/server/server_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {
namespace {

using Texts = ServerStatement::Values;

template <typename Integer>
std::optional<std::string> text_of(const std::optional<Integer>& number) {
    return number ? std::optional{std::to_string(*number)} : std::nullopt;
}

/// Trip of the call.
struct Candidate {
    const NewTrip* trip;
    std::size_t place; ///< in the call
    std::string mark;  ///< that it would have if it was forgotten
    std::string car;   ///< pseudonym; "" for a survey
    std::int64_t row = 0;
    bool is_new = false;
};

/// Drive of a candidate, which has no row yet, by its place in the order of candidates.
struct CandidateDrive {
    std::int64_t chunk;
    std::size_t candidate;
    std::int64_t drive;
    friend auto operator<=>(const CandidateDrive&, const CandidateDrive&) = default;
};

/// In the order of their hashes.
std::vector<Candidate> candidates_of(std::span<const NewTrip> trips, const PrivacyKey* key) {
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < trips.size(); ++i) {
        const auto& trip = *trips[i].trip;
        std::string car;
        if (!trip.reference) {
            car = key != nullptr ? key->pseudonym(trip.vehicle_id) : std::string{unknown_car};
        }
        candidates.push_back({&trips[i], i, forgotten_mark(trip.sha256), std::move(car)});
    }
    std::ranges::stable_sort(candidates, {}, [](const Candidate& candidate) {
        return std::string_view{candidate.trip->trip->sha256};
    });
    return candidates;
}

ServerStatement readmitting(const std::vector<Candidate>& candidates) {
    std::vector<std::string> marks;
    for (const auto& candidate : candidates) {
        if (candidate.trip->readmit) {
            marks.push_back(candidate.mark);
        }
    }
    return ServerStatement{"DELETE FROM macadam.forgotten WHERE mark = ANY($1::text[])",
                           Texts{array_of(marks)}};
}

/// Adds cars that are new, but none of a trip that was forgotten.
ServerStatement adding_cars(const std::vector<Candidate>& candidates) {
    std::vector<std::string> cars, marks;
    for (const auto& candidate : candidates) {
        if (!candidate.car.empty()) {
            cars.push_back(candidate.car);
            marks.push_back(candidate.mark);
        }
    }
    return ServerStatement{
        "INSERT INTO macadam.vehicle (pseudonym) SELECT DISTINCT car"
        " FROM unnest($1::text[], $2::text[]) AS new (car, mark)"
        " WHERE NOT EXISTS (SELECT FROM macadam.vehicle WHERE pseudonym = car)"
        " AND NOT EXISTS (SELECT FROM macadam.forgotten WHERE forgotten.mark = new.mark)"
        " ORDER BY car ON CONFLICT (pseudonym) DO NOTHING",
        Texts{array_of(cars), array_of(marks)}};
}

/// Gives no row for a trip that was forgotten. That of one that is already stored is written all
/// the same, so that the commit waits for the standby before anybody is told that it is.
ServerStatement adding_trip(const Candidate& candidate) {
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
                 std::to_string(trip.trimmed_mm),
                 candidate.mark};
    if (trip.reference) {
        values[11] = std::to_string(trip.reference->relative_sd_ppm);
        values[12] = std::to_string(trip.reference->row_mm);
    } else {
        values[2] = candidate.car;
    }
    // xmax is the transaction that changed or locked a row: 0 for one that was just inserted.
    return ServerStatement{
        "INSERT INTO macadam.trip AS trip (sha256, trip_id, vehicle, file_name, t0_utc_ms,"
        " vehicle_model, method, distance_mm, matched_mm, rows_read, rows_used, reference_ppm,"
        " reference_row_mm, trimmed_mm) SELECT $1, $2, (SELECT id FROM macadam.vehicle"
        " WHERE pseudonym = $3), $4, $5::bigint, $6, $7, $8::bigint, $9::bigint, $10::bigint,"
        " $11::bigint, $12::bigint, $13::bigint, $14::bigint"
        " WHERE NOT EXISTS (SELECT FROM macadam.forgotten WHERE mark = $15)"
        " ON CONFLICT (sha256) DO UPDATE SET trip_id = trip.trip_id"
        " RETURNING id, (trip.xmax = 0)::integer",
        values};
}

class TripWriting {
public:
    TripWriting(const TripTarget& target, std::span<const NewTrip> trips)
        : to_{&target}, candidates_{candidates_of(trips, target.key)} {
        const Transaction one_look{target.image.database, Transaction::Kind::read};
        for (std::size_t i = 0; i < candidates_.size(); ++i) {
            collect_drives(i);
        }
        for (const auto& [name, drive] : drives_) {
            cells_.insert(target.rows.place_of(name.chunk).cell);
        }
    }

    std::vector<bool> write() {
        ServerTransaction all{to_->server};
        const bool has_cells = write_trip_rows();
        write_drives(has_cells);
        std::vector<ServerStatement> last;
        if (std::ranges::any_of(candidates_, &Candidate::is_new)) {
            last.push_back(adding_reasons());
            last.push_back(adding_searches());
            last.push_back(adding_events());
            last.push_back(marking_chunks());
        }
        all.commit(last);
        std::vector<bool> added(candidates_.size());
        for (const auto& candidate : candidates_) {
            added[candidate.place] = candidate.is_new;
        }
        return added;
    }

private:
    void collect_drives(std::size_t number) {
        const auto& trip = *candidates_[number].trip;
        const double length_m = to_->image.settings.segment_length_m;
        for (const auto& pass : trip.passes) {
            const auto segment = to_->rows.row_of(pass.segment);
            const auto chunk = to_->rows.row_of(chunk_of(pass.segment, length_m));
            const auto offset = static_cast<std::uint32_t>(segment - chunk);
            drives_[{chunk, number, drive_number(pass)}].passes.push_back({offset, pass});
        }
        for (const auto& trace : trip.traces) { // it can also shift others where there is no pass
            drives_[{to_->rows.row_of(trace.chunk), number, trace.drive}].trace =
                drive_trace_of(trace);
        }
    }

    /// \returns whether other servers hold cells of the database.
    bool write_trip_rows() {
        std::vector<ServerStatement> statements{
            sharing_database(), asking_for_settings(), asking_for_cells(), sharing_cells(cells_)};
        if (std::ranges::any_of(candidates_, [](const auto& one) { return one.trip->readmit; })) {
            statements.push_back(readmitting(candidates_));
        }
        statements.push_back(adding_cars(candidates_));
        const auto before = statements.size();
        for (const auto& candidate : candidates_) {
            statements.push_back(adding_trip(candidate));
        }
        const auto rows = to_->server.rows_of_all(statements);
        expect_same_settings(
            to_->server, to_->settings, settings_in(rows.at(1)), to_->results_version);
        for (std::size_t i = 0; i < candidates_.size(); ++i) {
            const auto& found = rows.at(before + i);
            if (!found.empty()) { // it was not forgotten
                candidates_[i].row =
                    exact_number<std::int64_t>(found[0].at(0).value_or("")).value_or(0);
                candidates_[i].is_new = found[0].at(1) == "1";
            }
        }
        return rows.at(2).at(0).at(0) == "1";
    }

    void write_drives(bool has_cells) {
        std::erase_if(
            drives_, [&](const auto& drive) { return !candidates_[drive.first.candidate].is_new; });
        if (drives_.empty()) {
            return;
        }
        const bool elsewhere = has_cells && are_elsewhere(to_->server, cells_);
        const auto& table = server_table("drive");
        CopyWriter writer{to_->server,
                          elsewhere ? to_->cells.place() : copy_target(table),
                          static_cast<int>(table.columns.size())};
        std::set<std::int64_t> trips;
        for (auto& [name, drive] : drives_) {
            const auto trip = candidates_[name.candidate].row;
            trips.insert(trip);
            write_drive(writer,
                        to_->rows.place_of(name.chunk).cell,
                        {name.chunk, trip, name.drive},
                        std::move(drive));
        }
        writer.finish();
        if (elsewhere) {
            to_->cells.put(std::vector<std::int64_t>{trips.begin(), trips.end()});
        }
    }

    ServerStatement adding_reasons() const {
        std::vector<std::int64_t> trips, counts;
        std::vector<std::string> reasons;
        for (const auto& candidate : new_candidates()) {
            for (const auto& [reason, rows] : candidate.trip->trip->row_reasons) {
                trips.push_back(candidate.row);
                reasons.push_back(reason);
                counts.push_back(static_cast<std::int64_t>(rows));
            }
        }
        return ServerStatement{"INSERT INTO macadam.row_reason (trip, reason, rows)"
                               " SELECT * FROM unnest($1::bigint[], $2::text[], $3::bigint[])",
                               Texts{array_of(trips), array_of(reasons), array_of(counts)}};
    }

    ServerStatement adding_searches() const {
        std::vector<std::int64_t> searched;
        for (const auto& candidate : new_candidates()) {
            if (candidate.trip->events) {
                searched.push_back(candidate.row);
            }
        }
        return ServerStatement{
            "INSERT INTO macadam.event_search (trip) SELECT unnest($1::bigint[])",
            Texts{array_of(searched)}};
    }

    ServerStatement adding_events() {
        const auto& table = server_table("event");
        std::vector<std::vector<std::int64_t>> columns(table.columns.size());
        for (const auto& candidate : new_candidates()) {
            const auto events = candidate.trip->events.value_or(std::span<const PassEvent>{});
            for (const auto& [number, event] : numbered_events(events)) {
                const std::array<std::int64_t, 11> values{to_->rows.row_of(event.segment),
                                                          candidate.row,
                                                          event.occurrence,
                                                          number,
                                                          static_cast<std::int64_t>(event.kind),
                                                          static_cast<std::int64_t>(event.track),
                                                          event.at_mm,
                                                          event.place_sd_mm,
                                                          event.size_um,
                                                          event.sd_um,
                                                          event.length_mm};
                for (std::size_t i = 0; i < values.size(); ++i) {
                    columns.at(i).push_back(values[i]);
                }
            }
        }
        Texts values;
        std::string arrays;
        for (const auto& column : columns) {
            values.emplace_back(array_of(column));
            arrays += fmt::format("{}${}::bigint[]", arrays.empty() ? "" : ", ", values.size());
        }
        return ServerStatement{
            fmt::format("INSERT INTO macadam.event ({}) SELECT * FROM unnest({})",
                        column_list(table),
                        arrays),
            std::move(values)};
    }

    /// Rows of its own for each trip: nobody waits for another who marks or fuses the same chunk.
    ServerStatement marking_chunks() const {
        std::vector<std::int64_t> chunks, trips;
        for (const auto& [name, drive] : drives_) {
            const auto trip = candidates_[name.candidate].row;
            if (chunks.empty() || chunks.back() != name.chunk || trips.back() != trip) {
                chunks.push_back(name.chunk);
                trips.push_back(trip);
            }
        }
        return ServerStatement{
            "INSERT INTO macadam.chunk_dirty (chunk, trip, since_ms)"
            " SELECT chunk, trip, (extract(epoch FROM clock_timestamp()) * 1000)::bigint"
            " FROM unnest($1::bigint[], $2::bigint[]) AS new (chunk, trip)",
            Texts{array_of(chunks), array_of(trips)}};
    }

    std::vector<Candidate> new_candidates() const {
        std::vector<Candidate> found;
        std::ranges::copy_if(candidates_, std::back_inserter(found), &Candidate::is_new);
        return found;
    }

    const TripTarget* to_;
    std::vector<Candidate> candidates_;
    std::map<CandidateDrive, ChunkDrive> drives_;
    std::set<std::int32_t> cells_;
};

} // namespace

std::vector<bool> write_trips(const TripTarget& target, std::span<const NewTrip> trips) {
    return TripWriting{target, trips}.write();
}

} // namespace macadam
