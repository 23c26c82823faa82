#include "storage/store/fusion/store_version.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

std::vector<std::int64_t> rows_of(Statement& select) {
    std::vector<std::int64_t> rows;
    while (select.step()) {
        rows.push_back(select.integer(0));
    }
    return rows;
}

} // namespace

StoreVersion moment_of(Database& database) {
    constexpr int beyond_audit = 40; // bits
    const auto select = fmt::format(
        "SELECT coalesce(max(id), 0) + coalesce((SELECT CAST(value AS INTEGER) << {} FROM meta"
        " WHERE key = '{}'), 0) FROM audit WHERE what <> 'import'",
        beyond_audit,
        late_trips_key);
    return {database.number(select.c_str()),
            database.number("SELECT coalesce(max(id), 0) FROM main.trip")};
}

bool only_forgot(Database& database, const StoreVersion& before, const StoreVersion& now) {
    auto copied = database.prepare("SELECT count(*) FROM main.meta WHERE key = ?");
    if (now.maintenance <= before.maintenance || !copied.bind(mirror_moment_key).step() ||
        copied.integer(0) != 0) {
        return false;
    }
    auto others = database.prepare(
        "SELECT count(*) FROM main.audit WHERE id > ? AND what <> 'import'"
        " AND (what <> 'forget' OR detail LIKE '%calibrated%')"); // as forget() words it
    return others.bind(before.maintenance).step() && others.integer(0) == 0;
}

std::vector<std::int64_t> chunks_changed_from(Database& database, std::int64_t audit) {
    auto select = database.prepare(
        "SELECT DISTINCT segment.strip FROM main.state_change AS change CROSS JOIN segment"
        " ON segment.fid = change.segment WHERE change.audit >= ? ORDER BY 1");
    select.bind(audit);
    return rows_of(select);
}

std::int64_t count_of_maps(Database& database) {
    return database.number(
        "SELECT count(*) FROM main.audit WHERE what IN ('network', 'background')");
}

std::vector<std::int64_t> chunks_driven_since(Database& database, const StoreVersion& before) {
    auto select = database.prepare(
        "SELECT segment.strip FROM main.pass AS pass CROSS JOIN segment"
        " ON segment.fid = pass.segment WHERE pass.trip > ?1"
        " UNION SELECT strip FROM main.trace INDEXED BY trace_of_trip WHERE trip > ?1 ORDER BY 1");
    select.bind(before.last_trip);
    return rows_of(select);
}

std::vector<std::int64_t> driven_chunks(Database& database) {
    auto select = database.prepare(
        "SELECT DISTINCT segment.strip FROM (SELECT DISTINCT segment FROM pass) AS driven"
        " CROSS JOIN segment ON segment.fid = driven.segment ORDER BY 1");
    return rows_of(select);
}

std::vector<std::int64_t> dirty_chunks(Database& database) {
    auto select = database.prepare(
        "SELECT segment.strip FROM segment_dirty AS dirty"
        " CROSS JOIN segment ON segment.fid = dirty.segment UNION SELECT strip FROM strip_dirty"
        " ORDER BY 1");
    return rows_of(select);
}

} // namespace macadam
