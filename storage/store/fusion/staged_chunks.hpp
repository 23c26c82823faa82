#pragma once

#include "storage/sqlite/sqlite.hpp"
#include "storage/store/fusion/chunk_states.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace macadam {

/// Fused chunks that are laid aside until they are put in place, in the temporary file of the
/// connection, which nobody else sees and which goes with it. One at a time for a connection, and
/// made outside of transactions.
class StagedChunks {
public:
    explicit StagedChunks(Database& database);
    StagedChunks(const StagedChunks&) = delete;
    StagedChunks& operator=(const StagedChunks&) = delete;
    ~StagedChunks();

    void put(std::int64_t chunk, const FusedChunk& fused);

    /// Nothing if it is not there.
    std::optional<FusedChunk> find(std::int64_t chunk);

    void remove(std::span<const std::int64_t> chunks);
    void clear();

private:
    struct Table { ///< there before statements are made of it
        explicit Table(Database& database);
    };

    Database* database_;
    Table table_;
    Statement insert_;
    Statement select_;
    Statement remove_;
};

} // namespace macadam
