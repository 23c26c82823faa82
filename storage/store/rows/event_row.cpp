#include "storage/store/rows/event_row.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <limits>

namespace macadam {
namespace {

/// Converts a stored number to an enumerator up to `last`.
template <typename Enum>
Enum enumerator(const Database& database, std::int64_t number, Enum last, const char* column) {
    if (number < 0 || number > static_cast<std::int64_t>(last)) {
        throw InputError{fmt::format("{}: {} of an event is {}, expected 0 to {}; the database was "
                                     "modified by another program",
                                     database.file().string(),
                                     column,
                                     number,
                                     static_cast<int>(last))};
    }
    return static_cast<Enum>(number);
}

std::int32_t number_in(const Statement& row, int column) {
    return static_cast<std::int32_t>(row.integer(column));
}

/// Returns a stored standard deviation, by which fusion divides.
std::int32_t sd_in(const Database& database, const Statement& row, int column, const char* name) {
    const auto value = row.integer(column);
    if (value <= 0 || value > std::numeric_limits<std::int32_t>::max()) {
        throw InputError{fmt::format("{}: {} of an event is {}, expected more than 0; the database "
                                     "was modified by another program",
                                     database.file().string(),
                                     name,
                                     value)};
    }
    return static_cast<std::int32_t>(value);
}

} // namespace

const char* const event_columns = "event.kind, event.track, event.at_mm, event.place_sd_mm,"
                                  " event.size_um, event.sd_um, event.length_mm";

PassEvent event_in(const Database& database,
                   const Statement& row,
                   int first,
                   const SegmentKey& segment,
                   std::uint32_t occurrence) {
    return {.segment = segment,
            .occurrence = occurrence,
            .kind = enumerator(database, row.integer(first), EventKind::rail, "kind"),
            .track = enumerator(database, row.integer(first + 1), WheelTrack::both, "track"),
            .at_mm = row.integer(first + 2),
            .place_sd_mm = sd_in(database, row, first + 3, "place_sd_mm"),
            .size_um = number_in(row, first + 4),
            .sd_um = sd_in(database, row, first + 5, "sd_um"),
            .length_mm = number_in(row, first + 6)};
}

const char* const published_event_columns =
    "event.kind, event.track, event.at_mm, event.place_sd_mm, event.size_um, event.sd_um,"
    " event.length_mm, event.passes, event.passes_over, event.vehicles, event.first_seen_ms,"
    " event.last_seen_ms";

FusedEvent published_event_in(const Database& database,
                              const Statement& row,
                              int first,
                              const SegmentKey& segment) {
    const auto event = event_in(database, row, first, segment, 0);
    return {.segment = segment,
            .kind = event.kind,
            .track = event.track,
            .at_mm = event.at_mm,
            .place_sd_mm = event.place_sd_mm,
            .size_um = event.size_um,
            .sd_um = event.sd_um,
            .length_mm = event.length_mm,
            .passes = number_in(row, first + event_column_count),
            .passes_over = number_in(row, first + event_column_count + 1),
            .vehicles = number_in(row, first + event_column_count + 2),
            .first_seen_ms = row.known_integer(first + event_column_count + 3),
            .last_seen_ms = row.known_integer(first + event_column_count + 4)};
}

void write_published_event(Statement& insert,
                           std::int64_t segment,
                           std::int64_t number,
                           const FusedEvent& event) {
    insert.run(segment,
               number,
               static_cast<std::int64_t>(event.kind),
               static_cast<std::int64_t>(event.track),
               event.at_mm,
               std::int64_t{event.place_sd_mm},
               std::int64_t{event.size_um},
               std::int64_t{event.sd_um},
               std::int64_t{event.length_mm},
               std::int64_t{event.passes},
               std::int64_t{event.passes_over},
               std::int64_t{event.vehicles},
               event.first_seen_ms,
               event.last_seen_ms);
}

} // namespace macadam
