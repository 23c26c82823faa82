#include "storage/store/connection/store_connection.hpp"
#include "storage/store/fusion/chunk_trace_rows.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/store/rows/old_changes.hpp"
#include "storage/store/rows/segment_row.hpp"
#include "storage/store/schema/store_schema.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace macadam {
namespace {

AuditEntry entry_in(const Statement& row) {
    const auto segments = row.known_integer(5);
    return {.id = row.integer(0),
            .at = row.text(1),
            .generation = static_cast<int>(row.integer(2)),
            .what = row.text(3),
            .detail = row.text(4),
            .segments =
                segments ? std::optional{static_cast<std::size_t>(*segments)} : std::nullopt};
}

} // namespace

std::vector<HistoricPass> StoreReader::history(const SegmentKey& key) const {
    Transaction one_moment{store_->database, Transaction::Kind::read};
    auto select = store_->database.prepare(
        fmt::format("SELECT trip.sha256, vehicle.pseudonym, trip.t0_utc_ms, segment.strip,"
                    " (segment.from_m + segment.to_m) / 2, trip.reference_ppm, trip.trip_id,"
                    " {} FROM segment"
                    " CROSS JOIN pass ON pass.segment = segment.fid"
                    " CROSS JOIN trip ON trip.id = pass.trip"
                    " LEFT JOIN vehicle ON vehicle.id = trip.vehicle"
                    " WHERE segment.way_id = ? AND segment.direction = ? AND segment.seq = ?"
                    " ORDER BY trip.sha256, pass.occurrence",
                    pass_columns));
    select.bind(key.way_id, key.forward ? "forward" : "backward", std::int64_t{key.index});
    std::vector<HistoricPass> passes;
    std::optional<std::vector<AlignedTrace>> traces;
    while (select.step()) {
        if (!traces) {
            traces = ChunkTraces{store_->database}.placed(select.integer(3));
        }
        HistoricPass record{
            pass_in(select, 7, key), select.text(0), select.text(1), known_utc_ms(select, 2)};
        if (!select.is_null(5)) {
            record.reference = select.text(6);
        }
        record.utc_ms = utc_ms_of(record.utc_ms, record.pass);
        if (const auto* placed = find_trace(*traces, record.trip_sha256, record.pass.drive)) {
            record.lag_m = lag_m(placed->lag, station_m(key.forward, select.real(4)));
            record.finding = placed->lag.finding;
        }
        passes.push_back(std::move(record));
    }
    return passes;
}

std::vector<AuditEntry> StoreReader::audit() const {
    auto select = store_->database.prepare(
        "SELECT audit.id, at, generation, what, detail,"
        " CASE WHEN id >= ? THEN ifnull(changed.segments, 0) END FROM audit"
        " LEFT JOIN (SELECT audit, count(*) AS segments FROM state_change GROUP BY audit) AS "
        "changed"
        " ON changed.audit = audit.id ORDER BY 1");
    std::vector<AuditEntry> entries;
    select.bind(first_kept_audit(store_->database));
    while (select.step()) {
        entries.push_back(entry_in(select));
    }
    return entries;
}

std::vector<NumberChange> StoreReader::changes(const SegmentKey& key) const {
    auto select = store_->database.prepare(
        "SELECT audit.id, at, generation, what, detail, 1, iri_um, sd_um, passes FROM segment"
        " CROSS JOIN state_change ON state_change.segment = segment.fid"
        " CROSS JOIN audit ON audit.id = state_change.audit"
        " WHERE way_id = ? AND direction = ? AND seq = ? ORDER BY audit.id");
    select.bind(key.way_id, key.forward ? "forward" : "backward", std::int64_t{key.index});
    std::vector<NumberChange> changes;
    const auto known_um = [&](int column) {
        const auto um = select.known_integer(column);
        return um ? std::optional{static_cast<IriUm>(*um)} : std::nullopt;
    };
    while (select.step()) {
        changes.push_back({entry_in(select), known_um(6), known_um(7), select.integer(8)});
    }
    return changes;
}

std::vector<ValidSince> StoreReader::valid_since() const {
    auto select = store_->database.prepare(
        "SELECT way_id, direction, seq, from_ms FROM valid_from"
        " CROSS JOIN segment ON segment.fid = valid_from.segment ORDER BY " +
        std::string{order_of_keys});
    std::vector<ValidSince> all;
    while (select.step()) {
        all.push_back({key_in(select, 0), select.integer(3)});
    }
    return all;
}

} // namespace macadam
