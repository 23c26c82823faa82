#include "storage/store/fusion/staged_chunks.hpp"

#include <sqlite3.h>

#include <cstring>
#include <string>
#include <type_traits>

namespace macadam {
namespace {

// The bytes are only used by the process that made them.
static_assert(std::is_trivially_copyable_v<FusedSegment> &&
              std::is_trivially_copyable_v<AlignmentSummary>);

std::string bytes_of(const FusedChunk& fused) {
    const auto of_segments = fused.segments.size() * sizeof(FusedSegment);
    std::string bytes(sizeof fused.alignment + of_segments, '\0');
    std::memcpy(bytes.data(), &fused.alignment, sizeof fused.alignment);
    if (of_segments > 0) {
        std::memcpy(bytes.data() + sizeof fused.alignment, fused.segments.data(), of_segments);
    }
    return bytes;
}

FusedChunk chunk_in(std::string_view bytes) {
    FusedChunk fused{};
    std::memcpy(&fused.alignment, bytes.data(), sizeof fused.alignment);
    bytes.remove_prefix(sizeof fused.alignment);
    fused.segments.resize(bytes.size() / sizeof(FusedSegment));
    if (!bytes.empty()) {
        std::memcpy(fused.segments.data(), bytes.data(), bytes.size());
    }
    return fused;
}

} // namespace

StagedChunks::Table::Table(Database& database) {
    database.run("CREATE TEMP TABLE IF NOT EXISTS staged_strip"
                 " (strip INTEGER PRIMARY KEY NOT NULL, fused BLOB NOT NULL);"
                 "DELETE FROM temp.staged_strip");
}

StagedChunks::StagedChunks(Database& database)
    : database_{&database}, table_{database},
      insert_{database.prepare("INSERT OR REPLACE INTO temp.staged_strip VALUES (?, ?)")},
      select_{database.prepare("SELECT fused FROM temp.staged_strip WHERE strip = ?")},
      remove_{database.prepare("DELETE FROM temp.staged_strip WHERE strip = ?")} {}

StagedChunks::~StagedChunks() {
    sqlite3_exec(database_->handle(), "DELETE FROM temp.staged_strip", nullptr, nullptr, nullptr);
}

void StagedChunks::put(std::int64_t chunk, const FusedChunk& fused) {
    insert_.run(chunk, Blob{bytes_of(fused)});
}

std::optional<FusedChunk> StagedChunks::find(std::int64_t chunk) {
    std::optional<FusedChunk> found;
    if (select_.bind(chunk).step()) {
        found = chunk_in(select_.blob(0));
    }
    select_.reset();
    return found;
}

void StagedChunks::remove(std::span<const std::int64_t> chunks) {
    for (const auto chunk : chunks) {
        remove_.run(chunk);
    }
}

void StagedChunks::clear() {
    database_->run("DELETE FROM temp.staged_strip");
}

} // namespace macadam
