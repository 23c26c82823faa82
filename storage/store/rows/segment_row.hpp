#pragma once

#include "mapping/fusion/segment_state.hpp"
#include "mapping/passes/pass.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/sqlite/bulk_insert.hpp"
#include "storage/sqlite/row_callback.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/records/store_records.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace macadam {

// Conversion between table rows and values.

/// Columns of a segment and its state for `record_in`; the tables must be named segment and state.
/// The attributes of the way are not filled in (RoadNames).
extern const char* const record_columns;
SegmentRecord record_in(const Statement& row);

/// Reads into an existing record, to reuse its memory; name and class of its way are unchanged.
void put_record_in(const VisitedRow& row, SegmentRecord& record);

/// Columns for StateDetail::tiles.
extern const char* const tile_columns;
void put_tile_record_in(const VisitedRow& row, SegmentRecord& record);

/// Columns for a SegmentSummary; fewer columns are faster.
extern const char* const summary_columns;
void put_summary_in(const VisitedRow& row, SegmentRecord& record);

extern const char* const insert_state;
inline constexpr int state_column_count = 22;
void write_state(BulkInsert& insert,
                 std::int64_t fid,
                 const SegmentState& state,
                 const ClassTable& classes);

/// Columns of a pass, starting at column `first`; the table must be named pass.
extern const char* const pass_columns;
inline constexpr int digest_column_count = 12; ///< number of leading columns in the digest; the
                                               ///< last column, the drive, only refers to the trace
Pass pass_in(const Statement& row, int first, const SegmentKey& segment);

/// Key of a segment from columns way_id, direction and seq, the first of which is `first`.
SegmentKey key_in(const Statement& row, int first);

/// Time in milliseconds since 1970; `std::nullopt` for NULL and for implausible times, outside of
/// the years 1 to 9999.
std::optional<std::int64_t> known_utc_ms(const Statement& row, int column);

/// Time of a pass, from the start time of its trip; `std::nullopt` if that is unknown.
std::optional<std::int64_t> utc_ms_of(const std::optional<std::int64_t>& trip_utc_ms,
                                      const Pass& pass);

/// "HRI>MRI" or "MRI".
const char* name_of_index(bool centre_only);

/// Converts whole um/m to mm/m: 12345 -> 12.345.
double mm_per_m(IriUm um);

/// Formats a time as in a GeoPackage, always with milliseconds.
std::string datetime_text(std::int64_t utc_ms);

} // namespace macadam
