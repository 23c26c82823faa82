#include "storage/store/connection/store_connection.hpp"
#include "storage/store/privacy/car_order.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/store/rows/segment_row.hpp"
#include "storage/store/schema/store_schema.hpp"

#include <fmt/format.h>

#include <algorithm> // IWYU pragma: keep; std::ranges::upper_bound is not attributed to it
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

GeoBox box_of_segments(Database& database) {
    auto all = database.prepare("SELECT min_x, min_y, max_x, max_y FROM gpkg_contents"
                                " WHERE table_name = 'segment'");
    all.step();
    return {all.real(0), all.real(1), all.real(2), all.real(3)};
}

Cover cover_of(Database& database) {
    auto select = database.prepare(
        fmt::format("SELECT sum(to_m - from_m), min(ST_MinX(geom)), min(ST_MinY(geom)),"
                    " max(ST_MaxX(geom)), max(ST_MaxY(geom)) FROM segment WHERE fid IN {}",
                    with_passes));
    select.step();
    if (!select.is_null(0)) {
        return {select.real(0), {select.real(1), select.real(2), select.real(3), select.real(4)}};
    }
    return {0, box_of_segments(database)};
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

AlignmentSummary alignment_in(Database& database) {
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

ObservedPeriod StoreReader::seen() const {
    if (store_->seen_in_whole) {
        return *store_->seen_in_whole;
    }
    auto select =
        store_->database.prepare("SELECT min(first_seen_ms), max(last_seen_ms) FROM segment_state");
    select.step();
    return {known_utc_ms(select, 0), known_utc_ms(select, 1)};
}

StoreInfo StoreReader::info() const {
    auto& database = store_->database;
    Transaction one_moment{database, Transaction::Kind::read};
    const auto cover = cover_of(database);
    const auto span = seen();
    StoreInfo info{
        .settings = store_->settings,
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
        .classes = lengths_of(database, store_->classes()),
        .first_seen_ms = span.first_ms,
        .last_seen_ms = span.last_ms,
        .waiting = count(database, "SELECT count(*) FROM segment_dirty"),
        .alignment = alignment_in(database),
        .generation = read_generation(database),
        .box = cover.box};
    info.publication = latest_publication();
    info.published_alone = store_->published_alone;
    if (info.published_alone) {
        info.trips = static_cast<std::size_t>(info.publication ? info.publication->trips : 0);
        info.passes = count(database, "SELECT coalesce(sum(passes), 0) FROM segment_state");
    }
    return info;
}

GeoBox StoreReader::map_box() const {
    return box_of_segments(store_->database);
}

std::size_t StoreReader::waiting() const {
    return count(store_->database, "SELECT count(*) FROM segment_dirty");
}

AlignmentSummary StoreReader::alignment() const {
    return alignment_in(store_->database);
}

} // namespace macadam
