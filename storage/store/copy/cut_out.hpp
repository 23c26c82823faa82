#pragma once

#include "estimator/common/geo.hpp"
#include "estimator/common/progress.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/connection/store_connection.hpp"
#include "storage/store/rows/store_digest.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace macadam {

/// Contents of a database that is cut out of another one.
struct CutContent {
    std::span<const ChunkRows> chunks; ///< in the order of their keys
    /// Ways of the chunks, those that meet them, and maybe others, in order.
    std::span<const std::int64_t> ways_around;
    GeoBox ground;    ///< where what maps show below the roads is kept
    std::string from; ///< for the audit
};

/// Fills a new file, opened with Access::create, with what belongs to some chunks of a database:
/// their passes, traces, events, values and publications, the trips that drove there with their
/// cars, and all settings. Of roads, the ways of the chunks, and those that meet them, which decide
/// where these are cut into segments; segments of the latter are numbered anew, as roads beyond
/// them are missing.
///
/// \param source  of which all rows are visible
/// \throws InputError  if segments are not those of their ways, or a stop is requested.
void cut_out(StoreConnection& source,
             const CutContent& content,
             Database& file,
             const Progress& progress);

/// Ways of chunks, in order.
std::vector<std::int64_t> ways_of(Database& source, std::span<const ChunkRows> chunks);

} // namespace macadam
