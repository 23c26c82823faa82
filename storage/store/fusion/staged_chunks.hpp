#pragma once

#include "storage/sqlite/sqlite.hpp"
#include "storage/store/fusion/chunk_states.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace macadam {

/// Fused chunks, staged in a temporary table of the connection, which is private and deleted with
/// it. At most one instance per connection, created outside of transactions.
class StagedChunks {
public:
    explicit StagedChunks(Database& database);
    StagedChunks(const StagedChunks&) = delete;
    StagedChunks& operator=(const StagedChunks&) = delete;
    ~StagedChunks();

    void put(std::int64_t chunk, const FusedChunk& fused);

    /// Staged chunk; `std::nullopt` if there is none.
    std::optional<FusedChunk> find(std::int64_t chunk);

    void remove(std::span<const std::int64_t> chunks);
    void clear();

private:
    struct Table { ///< exists before statements are prepared on it
        explicit Table(Database& database);
    };

    Database* database_;
    Table table_;
    Statement insert_;
    Statement select_;
    Statement remove_;
};

} // namespace macadam
