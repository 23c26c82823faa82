#pragma once

#include "estimator/common/progress.hpp"
#include "storage/postgres/server_connection.hpp"
#include "storage/store/connection/store_connection.hpp"
#include "storage/store/rows/segment_rowids.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace macadam {

/// Settings of a database on a server that must be as they were while one writes to it.
struct ServerSettings {
    std::string network_rows; ///< name of the rows of its network
    std::string privacy;
    std::string key_id;
    std::string results_version{}; ///< of its workers; "" before the first one
};

/// Without the version of results, which readers may not see.
ServerSettings read_server_settings(ServerConnection& server);

/// \name All of them, among other statements
/// @{
ServerStatement asking_for_settings();
ServerSettings settings_in(const std::vector<ServerRow>& rows);
/// @}

/// \param results_version  of the program; `std::nullopt` fits all
/// \throws InputError  if they have changed, and nothing is to be written.
/// \throws OtherResults  if workers have another version of results.
void expect_same_settings(const ServerConnection& server,
                          const ServerSettings& before,
                          const ServerSettings& now,
                          std::optional<int> results_version);

/// Opens the roads and settings of a database on a server for reading: a database without trips
/// that is kept among this user's files, fetched if it is not there yet.
std::shared_ptr<StoreConnection> open_network_image(ServerConnection& server,
                                                    const ServerSettings& settings,
                                                    const Progress& progress);

/// Place of a chunk's rows on the server.
struct ChunkPlace {
    std::int32_t cell;
    std::int64_t first; ///< row of its first segment, which names it
    std::int64_t last;
};

/// Finds rows of the server in an image of its network.
class ImageRows {
public:
    explicit ImageRows(StoreConnection& image);

    /// \throws InputError  for a segment or a chunk that the network does not contain.
    std::int64_t row_of(const SegmentKey& segment) { return segments_.row_of(segment); }
    std::int64_t row_of(const ChunkKey& chunk) { return segments_.row_of(chunk); }

    /// Place of the chunk that begins with this row.
    ///
    /// \throws InputError  if none does.
    const ChunkPlace& place_of(std::int64_t chunk);

private:
    StoreConnection* image_;
    SegmentRowids segments_;
    Statement select_chunk_;
    Statement select_points_;
    std::unordered_map<std::int64_t, ChunkPlace> places_;
};

} // namespace macadam
