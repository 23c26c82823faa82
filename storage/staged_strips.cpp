#include "storage/staged_strips.hpp"

#include <sqlite3.h>

#include <cstring>
#include <string>
#include <type_traits>

namespace macadam {
namespace {

// The bytes never leave the process that made them.
static_assert(std::is_trivially_copyable_v<FusedSegment> &&
              std::is_trivially_copyable_v<LaySummary>);

std::string bytes_of(const FusedStrip& fused) {
    const auto of_segments = fused.segments.size() * sizeof(FusedSegment);
    std::string bytes(sizeof fused.laid + of_segments, '\0');
    std::memcpy(bytes.data(), &fused.laid, sizeof fused.laid);
    if (of_segments > 0) {
        std::memcpy(bytes.data() + sizeof fused.laid, fused.segments.data(), of_segments);
    }
    return bytes;
}

FusedStrip strip_in(std::string_view bytes) {
    FusedStrip fused{};
    std::memcpy(&fused.laid, bytes.data(), sizeof fused.laid);
    bytes.remove_prefix(sizeof fused.laid);
    fused.segments.resize(bytes.size() / sizeof(FusedSegment));
    if (!bytes.empty()) {
        std::memcpy(fused.segments.data(), bytes.data(), bytes.size());
    }
    return fused;
}

} // namespace

StagedStrips::Table::Table(Database& database) {
    database.run("CREATE TEMP TABLE IF NOT EXISTS staged_strip"
                 " (strip INTEGER PRIMARY KEY NOT NULL, fused BLOB NOT NULL);"
                 "DELETE FROM temp.staged_strip");
}

StagedStrips::StagedStrips(Database& database)
    : database_{&database}, table_{database},
      insert_{database.prepare("INSERT OR REPLACE INTO temp.staged_strip VALUES (?, ?)")},
      select_{database.prepare("SELECT fused FROM temp.staged_strip WHERE strip = ?")},
      remove_{database.prepare("DELETE FROM temp.staged_strip WHERE strip = ?")} {}

StagedStrips::~StagedStrips() {
    sqlite3_exec(database_->handle(), "DELETE FROM temp.staged_strip", nullptr, nullptr, nullptr);
}

void StagedStrips::put(std::int64_t strip, const FusedStrip& fused) {
    insert_.run(strip, Blob{bytes_of(fused)});
}

std::optional<FusedStrip> StagedStrips::find(std::int64_t strip) {
    std::optional<FusedStrip> found;
    if (select_.bind(strip).step()) {
        found = strip_in(select_.blob(0));
    }
    select_.reset();
    return found;
}

void StagedStrips::remove(std::span<const std::int64_t> strips) {
    for (const auto strip : strips) {
        remove_.run(strip);
    }
}

void StagedStrips::clear() {
    database_->run("DELETE FROM temp.staged_strip");
}

} // namespace macadam
