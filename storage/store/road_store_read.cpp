#include "estimator/common/error.hpp"
#include "storage/store/fusion/chunk_trace_rows.hpp"
#include "storage/store/privacy/car_order.hpp"
#include "storage/store/road_store_impl.hpp"
#include "storage/store/rows/segment_row.hpp"
#include "storage/store/upgrade/store_digest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace macadam {
namespace {

// ---------------------------------------------------------------------------------------- info

std::size_t count(Database& database, const char* sql) {
    return static_cast<std::size_t>(database.number(sql));
}

std::size_t count_with(Database& database, std::uint8_t flag) {
    return count(database,
                 fmt::format("SELECT count(*) FROM pass WHERE (validity & {}) <> 0", flag).c_str());
}

double real_meta(Database& database, const char* key) {
    auto select = database.prepare("SELECT CAST(value AS REAL) FROM meta WHERE key = ?");
    return select.bind(key).step() ? select.real(0) : 0;
}

/// Every segment with passes has a state or is dirty.
constexpr const char* with_passes = "(SELECT fid FROM segment_state"
                                    " UNION SELECT segment FROM segment_dirty)";

struct Cover {
    double length_m;
    GeoBox box;
};

Cover cover_of(Database& database) {
    auto select = database.prepare(
        fmt::format("SELECT sum(to_m - from_m), min(ST_MinX(geom)), min(ST_MinY(geom)),"
                    " max(ST_MaxX(geom)), max(ST_MaxY(geom)) FROM segment WHERE fid IN {}",
                    with_passes));
    select.step();
    if (!select.is_null(0)) {
        return {select.real(0), {select.real(1), select.real(2), select.real(3), select.real(4)}};
    }
    auto all = database.prepare("SELECT min_x, min_y, max_x, max_y FROM gpkg_contents"
                                " WHERE table_name = 'segment'");
    all.step();
    return {0, {all.real(0), all.real(1), all.real(2), all.real(3)}};
}

std::vector<ClassLength> lengths_of(Database& database, const ClassTable& classes) {
    auto select = database.prepare(
        "SELECT sum(segment.to_m - segment.from_m) / 1000 FROM segment_state AS state"
        " JOIN segment ON segment.fid = state.fid WHERE state.class = ?");
    std::vector<ClassLength> lengths;
    for (const auto& roughness : classes.classes) {
        select.bind(roughness.name).step();
        lengths.push_back({std::string{roughness.name}, select.real(0)});
    }
    return lengths;
}

AlignmentSummary laid_in(Database& database) {
    auto select = database.prepare("SELECT drives, found, beyond_reach, moved_far, middle_lag_cm"
                                   " FROM strip_state ORDER BY middle_lag_cm");
    AlignmentSummary whole;
    // Medians found so far, with their lags.
    std::vector<std::pair<std::int64_t, std::int64_t>> middles;
    while (select.step()) {
        whole.drives += select.integer(0);
        whole.found += select.integer(1);
        whole.beyond_reach += select.integer(2);
        whole.moved_far += select.integer(3);
        middles.emplace_back(whole.found, select.integer(4));
    }
    const auto middle = std::ranges::upper_bound(
        middles, whole.found / 2, {}, &std::pair<std::int64_t, std::int64_t>::first);
    whole.middle_lag_cm = middle == middles.end() ? 0 : static_cast<std::int32_t>(middle->second);
    return whole;
}

} // namespace

std::vector<HistoricPass> RoadStore::history(const SegmentKey& key) const {
    Transaction one_moment{impl_->database, Transaction::Kind::read};
    auto select = impl_->database.prepare(
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
    std::optional<std::vector<PlacedTrace>> traces;
    while (select.step()) {
        if (!traces) {
            traces = ChunkTraces{impl_->database}.placed(select.integer(3));
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

ObservedPeriod RoadStore::seen() const {
    auto select =
        impl_->database.prepare("SELECT min(first_seen_ms), max(last_seen_ms) FROM segment_state");
    select.step();
    return {known_utc_ms(select, 0), known_utc_ms(select, 1)};
}

StoreInfo RoadStore::info() const {
    auto& database = impl_->database;
    Transaction one_moment{database, Transaction::Kind::read};
    const auto cover = cover_of(database);
    const auto span = seen();
    StoreInfo info{
        .settings = impl_->settings,
        .trips = count(database, "SELECT count(*) FROM trip WHERE reference_ppm IS NULL"),
        .undated_trips = count(database,
                               "SELECT count(*) FROM trip WHERE t0_utc_ms IS NULL"
                               " AND reference_ppm IS NULL"),
        .passes = count(database, "SELECT count(*) FROM pass") -
                  count(database,
                        "SELECT count(*) FROM trip CROSS JOIN pass ON pass.trip = trip.id"
                        " WHERE trip.reference_ppm IS NOT NULL"),
        .lateral_passes = count_with(database, validity::lateral_alone),
        .vehicles = read_cars(database),
        .segments = static_cast<std::size_t>(real_meta(database, "segments")),
        .segments_with_passes = static_cast<std::size_t>(
            database.number(fmt::format("SELECT count(*) FROM {}", with_passes).c_str())),
        .km = cover.length_m / 1000,
        .network_km = real_meta(database, "network_m") / 1000,
        .classes = lengths_of(database, impl_->classes()),
        .first_seen_ms = span.first_ms,
        .last_seen_ms = span.last_ms,
        .waiting = count(database, "SELECT count(*) FROM segment_dirty"),
        .laid = laid_in(database),
        .generation = read_generation(database),
        .box = cover.box};
    info.publication = latest_publication();
    info.published_alone = impl_->published_alone;
    if (info.published_alone) {
        info.trips = static_cast<std::size_t>(info.publication ? info.publication->trips : 0);
        info.passes = count(database, "SELECT coalesce(sum(passes), 0) FROM segment_state");
    }
    return info;
}

std::vector<std::string> RoadStore::cars() const {
    return read_cars(impl_->database);
}

std::vector<VehicleUse> RoadStore::vehicle_uses() const {
    Transaction one_moment{impl_->database, Transaction::Kind::read};
    auto select = impl_->database.prepare(
        "SELECT vehicle.pseudonym, vehicle_model, method, count(*), count(*) - count(t0_utc_ms),"
        " sum((SELECT count(*) FROM pass WHERE pass.trip = trip.id)), sum(distance_mm),"
        " sum(matched_mm), sum(rows_read), sum(rows_used)"
        " FROM trip JOIN vehicle ON vehicle.id = trip.vehicle GROUP BY 1, 2, 3 ORDER BY 1, 2, 3");
    const auto number = [&](int column) {
        return static_cast<std::size_t>(select.integer(column));
    };
    std::vector<VehicleUse> uses;
    while (select.step()) {
        uses.push_back({.vehicle = select.text(0),
                        .vehicle_model = select.text(1),
                        .method = select.text(2),
                        .trips = number(3),
                        .undated_trips = number(4),
                        .passes = number(5),
                        .km = static_cast<double>(select.integer(6)) / 1e6,
                        .matched_km = static_cast<double>(select.integer(7)) / 1e6,
                        .rows_read = number(8),
                        .rows_used = number(9)});
    }
    const auto places = places_of_cars(cars());
    std::ranges::stable_sort(uses, {}, [&](const auto& use) { return places.at(use.vehicle); });
    return uses;
}

std::size_t RoadStore::waiting() const {
    return count(impl_->database, "SELECT count(*) FROM segment_dirty");
}

AlignmentSummary RoadStore::laid() const {
    return laid_in(impl_->database);
}

std::string RoadStore::digest() const {
    Transaction one_moment{impl_->database, Transaction::Kind::read};
    return digest_of(impl_->database, {});
}

} // namespace macadam
