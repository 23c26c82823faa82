#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/fusion/segment_state.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/postgres/copy_stream.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/server/drive_body.hpp"
#include "storage/store/server/server_tables.hpp"

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

// Values from and to rows of a server.

/// Key from columns way_id, direction and seq, the first of which is `first`.
SegmentKey segment_key_in(const CopyRow& row, int first);

/// Columns of a state, of a table named state.
extern const char* const server_state_columns;
inline constexpr int server_state_column_count = 16;
SegmentState server_state_in(const CopyRow& row, int first, const SegmentKey& segment);

/// Writes a row of table segment_state.
void write_server_state(CopyWriter& writer,
                        std::int32_t cell,
                        std::int64_t fid,
                        const SegmentState& state,
                        const ClassTable& classes);

/// Writes a row of a table that is copied row by row, from all its columns in a file.
void put_row(CopyWriter& writer, const Statement& row, const ServerTable& table);

/// Puts all columns of such a row into the same table of a file.
void put_row(Statement& insert, const CopyRow& row, const ServerTable& table);

/// Tables whose rows the server numbers.
inline constexpr std::array numbered_tables{"vehicle", "trip", "audit"};

/// Lets new rows of such a table get numbers after those that it has.
void continue_row_numbers(ServerConnection& server, const std::string& table);

/// Passes of table drive.
/// \throws InputError  that names the server, for a body that is none.
std::vector<DrivePass> server_passes_in(const ServerConnection& server,
                                        std::string_view body,
                                        std::uint32_t segments_per_chunk);

/// Chunk on a server: its map tile, and the row of its first segment.
struct ServerChunk {
    std::int32_t cell;
    std::int64_t row;
    friend auto operator<=>(const ServerChunk&, const ServerChunk&) = default;
};

/// \name Sources of rows of some chunks, as SQL: the chunks, to which tables are joined
/// @{

/// Chunks as rows of `wanted` (cell, chunk).
std::string wanted_chunks(std::span<const ServerChunk> chunks);

/// Joins rows of a table to each of the rows before, whatever the planner expects of their number:
/// where new tables have no statistics it would rather read all of them (OFFSET 0 keeps it out).
std::string join_each(std::string_view table, std::string_view alias, const std::string& condition);

/// Joins the segments of the chunks, whose rows are consecutive.
std::string join_segments(std::uint32_t segments_per_chunk);

/// Joins their states, as `state`, and the segments of these.
std::string join_states(std::uint32_t segments_per_chunk);
/// @}

/// \throws InputError  if a stop is requested.
void expect_no_stop(const ServerConnection& server, const Progress& progress);

} // namespace macadam
