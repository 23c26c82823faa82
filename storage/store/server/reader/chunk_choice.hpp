#pragma once

#include "storage/postgres/server_connection.hpp"
#include "storage/store/records/segment_filter.hpp"
#include "storage/store/server/copy/rows_from_server.hpp"

#include <vector>

namespace macadam {

/// Tests whether a filter leaves chunks out, as far as chunks_for() can tell.
bool chooses_chunks(const SegmentFilter& filter);

/// Finds the chunks of all segments that a filter may select, in order: by place, way, key, name,
/// class of road, values, and the worst ones. Time is in proportion to what an index finds; values
/// and names without a place read all of them.
std::vector<ServerChunk> chunks_for(ServerConnection& server, const SegmentFilter& filter);

} // namespace macadam
