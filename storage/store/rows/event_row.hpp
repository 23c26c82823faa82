#pragma once

#include "mapping/events/event_fusion.hpp"
#include "mapping/events/pass_event.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <cstdint>

namespace macadam {

// Rows of events read and written.

/// Columns of an event of a pass, after segment, trip and occurrence; the table must be named
/// event.
extern const char* const event_columns;
inline constexpr int event_column_count = 7;

/// \throws InputError  for an unknown kind or track, or a number out of its range, because the
/// database was modified.
PassEvent event_in(const Database& database,
                   const Statement& row,
                   int first,
                   const SegmentKey& segment,
                   std::uint32_t occurrence);

/// Columns of a published event after its segment and number; the table must be named event.
extern const char* const published_event_columns;

/// \throws InputError  as event_in().
FusedEvent published_event_in(const Database& database,
                              const Statement& row,
                              int first,
                              const SegmentKey& segment);

/// \param insert  into all columns of table published_event
void write_published_event(Statement& insert,
                           std::int64_t segment,
                           std::int64_t number,
                           const FusedEvent& event);

} // namespace macadam
