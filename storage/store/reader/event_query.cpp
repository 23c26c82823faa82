#include "estimator/common/error.hpp"
#include "mapping/geometry/point_along.hpp"
#include "storage/store/connection/store_connection.hpp"
#include "storage/store/fusion/chunk_events.hpp"
#include "storage/store/reader/pass_choice.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/store/rows/event_row.hpp"
#include "storage/store/rows/segment_row.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace macadam {
namespace {

constexpr double mm_per_m = 1000;

/// Segments of a filter on which an event may be, in the order of keys.
using SegmentsByKey = std::map<SegmentKey, SegmentRecord>;

/// Segments with events in a table.
std::set<SegmentKey> segments_in(Database& database, const char* table) {
    auto select = database.prepare(
        fmt::format("SELECT way_id, direction, seq FROM (SELECT DISTINCT segment FROM {}) AS event"
                    " CROSS JOIN segment ON segment.fid = event.segment",
                    table));
    std::set<SegmentKey> keys;
    while (select.step()) {
        keys.insert(key_in(select, 0));
    }
    return keys;
}

/// Adds the neighbours: alignment may move an event onto them.
std::set<SegmentKey> with_neighbours(const std::set<SegmentKey>& keys) {
    auto all = keys;
    for (auto key : keys) {
        ++key.index;
        all.insert(key);
        if (key.index >= 2) {
            key.index -= 2;
            all.insert(key);
        }
    }
    return all;
}

SegmentsByKey
places_of(const StoreReader& store, const SegmentFilter& filter, const std::set<SegmentKey>& keys) {
    SegmentsByKey places;
    if (keys.empty()) {
        return places;
    }
    store.visit(filter, [&](const SegmentRecord& record) {
        if (keys.contains(record.segment.key)) {
            places.emplace(record.segment.key, record);
        }
    });
    return places;
}

EventRecord record_of(FusedEvent event, const SegmentRecord& place) {
    const auto& segment = place.segment;
    const double along_m = static_cast<double>(event.at_mm) / mm_per_m;
    const double fraction = (along_m - segment.from_m) / (segment.to_m - segment.from_m);
    const auto at = point_along(segment.line, segment.key.forward ? fraction : 1 - fraction);
    return {std::move(event), at, place.name, place.highway};
}

std::vector<EventRecord> fused_events(const SegmentsByKey& places, WayEvents fusion) {
    std::vector<EventRecord> records;
    std::optional<std::pair<std::int64_t, bool>> last;
    for (const auto& [key, place] : places) {
        const std::pair way{key.way_id, key.forward};
        if (std::exchange(last, way) == way) {
            continue;
        }
        for (auto& event : fusion.of(key.way_id, key.forward)) {
            if (const auto found = places.find(event.segment); found != places.end()) {
                records.push_back(record_of(std::move(event), found->second));
            }
        }
    }
    return records;
}

std::vector<EventRecord> published_events(Database& database, const SegmentsByKey& places) {
    auto select = database.prepare(
        fmt::format("SELECT way_id, direction, seq, {} FROM published_event AS event"
                    " CROSS JOIN segment ON segment.fid = event.segment"
                    " ORDER BY way_id, direction DESC, seq, event.number",
                    published_event_columns));
    std::vector<EventRecord> records;
    while (select.step()) {
        if (const auto found = places.find(key_in(select, 0)); found != places.end()) {
            records.push_back(
                record_of(published_event_in(database, select, 3, found->first), found->second));
        }
    }
    return records;
}

} // namespace

std::vector<EventRecord> StoreReader::events(const SegmentFilter& filter) const {
    auto& database = store_->database;
    Transaction one_moment{database, Transaction::Kind::read};
    if (store_->published_alone) {
        if (filter.period) {
            throw InputError{fmt::format("{}: the events of a crowd database are published "
                                         "without months, expected no --since and --until",
                                         database.file().string())};
        }
        return published_events(database,
                                places_of(*this, filter, segments_in(database, "published_event")));
    }
    auto choice = pass_choice(database, filter);
    choice.cars_alone = true;
    const auto keys = with_neighbours(segments_in(database, "event"));
    return fused_events(places_of(*this, filter, keys),
                        {database, store_->segments_per_chunk(), choice});
}

} // namespace macadam
