#include "storage/store/connection/store_connection.hpp"
#include "storage/store/fusion/shadow_update.hpp"
#include "storage/store/maintenance/store_maintenance.hpp"
#include "storage/store/rows/audit.hpp"
#include "storage/store/rows/segment_row.hpp"

#include <fmt/format.h>

#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {
namespace {

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

std::size_t StoreMaintenance::set_valid_from(std::span<const SegmentKey> segments,
                                             const std::optional<std::int64_t>& from_ms,
                                             std::string_view reason,
                                             const Progress& progress) {
    auto& database = store_->database;
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
                      store_->segments_per_chunk(),
                      store_->classes(),
                      {build_shadow, "DROP TABLE IF EXISTS temp.valid_from", apply},
                      progress);
    store_->written(progress);
    return rows.size();
}

} // namespace macadam
