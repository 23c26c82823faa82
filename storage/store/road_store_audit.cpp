#include "storage/store/fusion/shadow_update.hpp"
#include "storage/store/road_store_impl.hpp"
#include "storage/store/rows/audit.hpp"
#include "storage/store/rows/segment_row.hpp"

#include <fmt/format.h>

#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {
namespace {

AuditEntry entry_in(const Statement& row) {
    return {.id = row.integer(0),
            .at = row.text(1),
            .generation = static_cast<int>(row.integer(2)),
            .what = row.text(3),
            .detail = row.text(4),
            .segments = static_cast<std::size_t>(row.integer(5))};
}

constexpr const char* find_segment =
    "SELECT fid FROM segment WHERE way_id = ? AND direction = ? AND seq = ?";

/// Rows of the segments that exist in the database.
std::vector<std::int64_t> rows_of(Database& database, std::span<const SegmentKey> segments) {
    auto find = database.prepare(find_segment);
    std::vector<std::int64_t> rows;
    for (const auto& key : segments) {
        find.bind(key.way_id, key.forward ? "forward" : "backward", std::int64_t{key.index});
        if (find.step()) {
            rows.push_back(find.integer(0));
        }
    }
    return rows;
}

std::vector<std::int64_t> chunks_of(Database& database, std::span<const std::int64_t> segments) {
    auto find = database.prepare("SELECT strip FROM segment WHERE fid = ?");
    std::set<std::int64_t> chunks;
    for (const auto row : segments) {
        find.bind(row).step();
        chunks.insert(find.integer(0));
    }
    return {chunks.begin(), chunks.end()};
}

void put_valid_from(Database& database,
                    std::span<const std::int64_t> segments,
                    const std::optional<std::int64_t>& from_ms) {
    auto insert = database.prepare("INSERT OR REPLACE INTO valid_from VALUES (?, ?)");
    auto remove = database.prepare("DELETE FROM valid_from WHERE segment = ?");
    for (const auto row : segments) {
        if (from_ms) {
            insert.run(row, *from_ms);
        } else {
            remove.run(row);
        }
    }
}

} // namespace

std::vector<AuditEntry> RoadStore::audit() const {
    auto select = impl_->database.prepare(
        "SELECT audit.id, at, generation, what, detail, ifnull(changed.segments, 0) FROM audit"
        " LEFT JOIN (SELECT audit, count(*) AS segments FROM state_change GROUP BY audit) AS "
        "changed"
        " ON changed.audit = audit.id ORDER BY 1");
    std::vector<AuditEntry> entries;
    while (select.step()) {
        entries.push_back(entry_in(select));
    }
    return entries;
}

std::vector<NumberChange> RoadStore::changes(const SegmentKey& key) const {
    auto select = impl_->database.prepare(
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

std::size_t RoadStore::set_valid_from(std::span<const SegmentKey> segments,
                                      const std::optional<std::int64_t>& from_ms,
                                      std::string_view reason,
                                      const Progress& progress) {
    auto& database = impl_->database;
    std::vector<std::int64_t> rows;
    const auto build_shadow = [&]() -> std::optional<std::vector<std::int64_t>> {
        rows = rows_of(database, segments);
        database.run("CREATE TEMP TABLE valid_from (segment INTEGER PRIMARY KEY, from_ms INTEGER);"
                     "INSERT INTO temp.valid_from SELECT * FROM main.valid_from");
        put_valid_from(database, rows, from_ms);
        return chunks_of(database, rows);
    };
    const auto apply = [&] {
        put_valid_from(database, rows, from_ms);
        return add_audit(
            database,
            "valid-from",
            fmt::format("{} segments {}{}{}",
                        segments.size(),
                        from_ms ? "from " + datetime_text(*from_ms) : std::string{"from any day"},
                        reason.empty() ? "" : ": ",
                        reason));
    };
    apply_maintenance(database,
                      segments_per_chunk(impl_->settings.segment_length_m),
                      impl_->classes(),
                      {build_shadow, "DROP TABLE IF EXISTS temp.valid_from", apply},
                      progress);
    return rows.size();
}

std::vector<ValidSince> RoadStore::valid_since() const {
    auto select = impl_->database.prepare(
        "SELECT way_id, direction, seq, from_ms FROM valid_from"
        " CROSS JOIN segment ON segment.fid = valid_from.segment ORDER BY " +
        std::string{order_of_keys});
    std::vector<ValidSince> all;
    while (select.step()) {
        all.push_back({{select.integer(0),
                        select.text(1) == "forward",
                        static_cast<std::uint32_t>(select.integer(2))},
                       select.integer(3)});
    }
    return all;
}

} // namespace macadam
