#pragma once

#include "storage/postgres/server_connection.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/fusion/chunk_states.hpp"
#include "storage/store/server/importer/network_image.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <unordered_set>
#include <vector>

namespace macadam {

/// Conditions that choose rows of some chunks in the partitioned tables of a server.
struct ChunkConditions {
    std::string cells;    ///< "cell IN (...)"
    std::string chunks;   ///< "chunk IN (...)"
    std::string fids;     ///< rows of their segments: "(fid BETWEEN 1 AND 25 OR ...)"
    std::string segments; ///< the same of columns named segment
};

/// \param chunks  rows of their first segments; not empty.
ChunkConditions conditions_of(std::span<const std::int64_t> chunks, ImageRows& rows);

/// Private database in memory, in which chunks of a server are fused by the code that fuses in
/// files. It holds the drives of a few chunks at a time.
class FusionScratch {
public:
    /// \param image  roads of the database; outlives this object, as do the others.
    FusionScratch(ServerConnection& server, StoreConnection& image, ImageRows& rows);

    /// Reads chunks within the caller's transaction and fuses them, by the rules that the server
    /// has now.
    std::vector<FusedChunk> fused(std::span<const std::int64_t> chunks);

private:
    void add_segments(std::span<const std::int64_t> chunks);
    void copy_rules(const ChunkConditions& conditions);
    void copy_rows(const char* table, const std::string& where);
    void copy_drives(const ChunkConditions& conditions);
    void copy_trips(std::span<const std::int64_t> trips);

    ServerConnection* server_;
    StoreConnection* image_;
    ImageRows* rows_;
    Database memory_;
    Statement select_segments_;
    std::unordered_set<std::int64_t> known_chunks_; ///< whose segments are in memory
};

} // namespace macadam
