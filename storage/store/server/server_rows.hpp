#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/fusion/segment_state.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/postgres/copy_stream.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/server/drive_body.hpp"
#include "storage/store/server/server_tables.hpp"

#include <array>
#include <cstdint>
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

/// \throws InputError  if a stop is requested.
void expect_no_stop(const ServerConnection& server, const Progress& progress);

} // namespace macadam
