#pragma once

#include "storage/sqlite/sqlite.hpp"
#include "storage/store/server/copy/rows_from_server.hpp"

#include <cstdint>
#include <functional>
#include <span>

namespace macadam {

/// Extent of a copy of a database on a server.
enum class ServerContent : std::uint8_t {
    network,   ///< roads and settings
    roads,     ///< also fused values and what maps show below: what role macadam_reader may read
    published, ///< of a crowd, roads and publications: what that role may read then
    all
};

/// Fills a new file, opened with Access::create, with a database on a server. Within the caller's
/// transaction there.
void fill_copy(RowsFromServer& rows, Database& file, ServerContent content);

/// Contents of a copy of some chunks besides roads and fused values.
struct PartContent {
    bool passes = false;       ///< with their trips and cars, and what fusion needs
    bool publications = false; ///< what a crowd's publications keep of the chunks
    bool background = false;   ///< what maps show below the roads
    std::span<const ServerChunk> roads_alone{}; ///< other chunks, of which there are roads alone
    std::span<const std::int64_t> trips{}; ///< with passes: other trips, by row, and their cars
    std::function<void()> others{};        ///< copies other rows
};

/// Fills a new file with some chunks of a database on a server and all of its settings.
void fill_part(RowsFromServer& rows,
               Database& file,
               std::span<const ServerChunk> chunks,
               const PartContent& content);

/// Copies what belongs to chunks, for a file that has their segments and nothing else of them.
void copy_chunks(RowsFromServer& rows, std::span<const ServerChunk> chunks, bool passes);

} // namespace macadam
