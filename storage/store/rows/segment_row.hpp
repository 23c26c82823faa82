#pragma once

#include "mapping/fusion/segment_state.hpp"
#include "mapping/passes/pass.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/sqlite/bulk_insert.hpp"
#include "storage/sqlite/row_callback.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/schema/store_records.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace macadam {

// How values stand in the rows of a store.

/// Columns of a segment and its state, as `record_in` reads them; the tables go by the names
/// segment and state. What is known of its way stays open (RoadNames).
extern const char* const record_columns;
SegmentRecord record_in(const Statement& row);

/// The same in the place of a record that is not needed any more, whose memory it takes; the name
/// and the class of its way stay.
void put_record_in(const VisitedRow& row, SegmentRecord& record);

/// The same as far as StateDetail::tiles goes.
extern const char* const tile_columns;
void put_tile_record_in(const VisitedRow& row, SegmentRecord& record);

/// The same as far as a SegmentSummary tells of it: each column takes its time.
extern const char* const summary_columns;
void put_summary_in(const VisitedRow& row, SegmentRecord& record);

extern const char* const insert_state;
inline constexpr int state_column_count = 22;
void write_state(BulkInsert& insert,
                 std::int64_t fid,
                 const SegmentState& state,
                 const ClassTable& classes);

/// Columns of a pass from the column `first` on; the table goes by the name pass.
extern const char* const pass_columns;
inline constexpr int digest_column_count = 12; ///< the first of them; the last, the drive, only
                                               ///< leads to the trace
Pass pass_in(const Statement& row, int first, const SegmentKey& segment);

/// A time in milliseconds since 1970; nothing for a column that holds none, or none of the years 1
/// to 9999, which nobody who means well has written.
std::optional<std::int64_t> known_utc_ms(const Statement& row, int column);

/// The time of a pass from that of its trip's begin; nothing where that is none.
std::optional<std::int64_t> utc_ms_of(const std::optional<std::int64_t>& trip_utc_ms,
                                      const Pass& pass);

/// "HRI>MRI" or "MRI".
const char* name_of_index(bool centre_only);

/// 12345 -> 12.345: mm/m of whole um/m.
double mm_per_m(IriUm um);

/// A time as a GeoPackage writes it, always with milliseconds.
std::string datetime_text(std::int64_t utc_ms);

} // namespace macadam
