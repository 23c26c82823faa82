#pragma once

#include "estimator/common/progress.hpp"
#include "storage/postgres/server_connection.hpp"
#include "storage/store/importer/import_target.hpp"
#include "storage/store/records/fusion_record.hpp"
#include "storage/store/server/importer/fusion_scratch.hpp"
#include "storage/store/server/importer/marked_chunks.hpp"
#include "storage/store/server/importer/network_image.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace macadam {

/// Fuses chunks of a database on a server, beside any number of others that import and fuse.
///
/// A batch of chunks is one transaction: it locks each chunk that is free by an advisory lock of
/// its number, reads its marks, then its drives, fuses them, writes what changed, and removes the
/// marks that it had read, so that no drive that arrives meanwhile is left unfused. Marks of cells
/// on other servers go in a second transaction, once these are known to keep what the first one
/// wrote.
class ServerFusion {
public:
    /// \param image  roads of the database; outlives this object, as do the others.
    /// \param expect_same  called at the begin of each transaction: takes the lock of an importer
    ///                     and checks that the database is still the one that was opened.
    ServerFusion(ServerConnection& server,
                 StoreConnection& image,
                 ImageRows& rows,
                 std::function<void()> expect_same);

    /// Fuses the marked chunks, each once, until all are done or a stop is requested: the next call
    /// then goes on with the others.
    ///
    /// \param record  of the earlier fusions of the same import; this one is added
    /// \returns the number of segments fused.
    std::size_t fuse_marked(const Progress& progress, FusionRecord& record, BusyChunks busy);

private:
    struct Batch;

    /// Fuses chunks, those that others hold once these are done with them.
    /// \param audit, segments  as of fuse()
    void fuse_all(std::span<const std::int64_t> chunks,
                  const Progress& progress,
                  std::optional<std::int64_t>& audit,
                  std::vector<std::int64_t>& segments);

    /// \param audit, segments  as of fuse()
    /// \returns the chunks that others hold.
    std::vector<std::int64_t> fuse_unlocked(std::span<const std::int64_t> chunks,
                                            const Progress& progress,
                                            std::optional<std::int64_t>& audit,
                                            std::vector<std::int64_t>& segments);

    /// \param audit  entry of the import
    /// \param segments  those fused are added.
    /// \returns the chunks that are done, rising: all but those that others hold.
    std::vector<std::int64_t> fuse(std::span<const std::int64_t> chunks,
                                   std::optional<std::int64_t>& audit,
                                   std::vector<std::int64_t>& segments);
    std::vector<std::int64_t> try_lock(std::span<const std::int64_t> chunks);
    /// \param audit  entry of the import; made if it has none and a value changes.
    void write(const Batch& batch, std::optional<std::int64_t>& audit);
    void write_alignments(const Batch& batch);
    void remove_marks(const Batch& batch);
    void remove_marks_once_kept(const Batch& batch, const std::set<std::int32_t>& cells);

    ServerConnection* server_;
    StoreConnection* image_;
    ImageRows* rows_;
    std::function<void()> expect_same_;
    FusionScratch scratch_;
    MarkedChunks marked_;
};

} // namespace macadam
