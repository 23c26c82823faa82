#pragma once

#include "estimator/common/geo.hpp"
#include "estimator/common/progress.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/postgres/server_connection.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/records/privacy_profile.hpp"
#include "storage/store/server/server_rows.hpp"
#include "storage/store/server/server_tables.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace macadam {

/// Copies rows of a database on a server into the tables of a file. Rows of chunks are copied for
/// all chunks or for some, which must not be empty. Consistent only within a transaction.
///
/// \throws InputError  from each call: for rows that another program modified, and if a stop is
///                     requested.
class RowsFromServer {
public:
    /// Chunks whose rows are copied; `std::nullopt`: all.
    using Chunks = std::optional<std::span<const ServerChunk>>;

    /// Reads the settings. The other objects outlive this one.
    RowsFromServer(ServerConnection& server, Database& file, const Progress& progress);

    const ClassTable& classes() const { return *classes_; }
    PrivacyProfile privacy() const { return privacy_; }
    std::uint32_t chunk_size() const { return chunk_size_; }

    /// Copies settings, without version and format, which are of the file.
    void copy_meta();

    /// Copies rows of a table that is copied row by row.
    /// \param condition  of SQL, of our own; "" = all. Rows that are there stay as they are.
    void copy_rows(const ServerTable& table, const std::string& condition = {});

    /// Copies table publication without the rows of trips and segments that it reached to, which
    /// readers must not see.
    void copy_publications();

    void copy_segments(const Chunks& chunks);
    void copy_states(const Chunks& chunks);
    void copy_drives(const Chunks& chunks);
    /// Copies passes of trips, without traces, but over these chunks.
    void copy_passes_elsewhere(std::span<const std::int64_t> trips,
                               std::span<const ServerChunk> held);
    /// Copies rows of tables chunk_state, event, state_change and published_...
    void copy_rows_of(const ServerTable& table, std::span<const ServerChunk> chunks);
    /// Copies marks of chunks that are to be fused, which stand for all their segments with passes.
    void copy_marks();

    /// Copies trips with what belongs to them but their passes, and their cars.
    void copy_trips(std::span<const std::int64_t> trips);
    /// Copies audit entries of changes that were copied.
    void copy_audit_of_changes();

    /// Box around the segments that were copied.
    const GeoBox& box() const { return box_; }

private:
    std::string setting(const char* key);
    std::string from(const char* table, const Chunks& chunks) const;
    void copy_drives_of(const std::string& select);

    ServerConnection* server_;
    Database* file_;
    const Progress* progress_;
    const ClassTable* classes_ = nullptr;
    PrivacyProfile privacy_ = PrivacyProfile::own;
    std::uint32_t chunk_size_ = 0;
    GeoBox box_{};
    bool is_first_point_ = true;
    std::size_t drives_ = 0; ///< copied so far
};

} // namespace macadam
