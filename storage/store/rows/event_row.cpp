#include "storage/store/rows/event_row.hpp"

#include "estimator/common/error.hpp"
#include "storage/store/rows/segment_row.hpp"

#include <fmt/format.h>

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

// Of a stored number, in um, mm or passes: room for sums and rounding in 32 bits.
constexpr std::int64_t max_number = 1'000'000'000;

constexpr std::int64_t max_at_mm = 1'000'000'000'000; // along a way: more than around the globe

/// Returns a stored number from `min` to `max`.
std::int64_t number_in(const Database& database,
                       const Statement& row,
                       int column,
                       const char* name,
                       std::int64_t min,
                       std::int64_t max) {
    const auto value = row.integer(column);
    if (value < min || value > max) {
        throw InputError{fmt::format("{}: {} of an event is {}, expected {} to {}; the database "
                                     "was modified by another program",
                                     database.file().string(),
                                     name,
                                     value,
                                     min,
                                     max)};
    }
    return value;
}

std::int32_t
number_in(const Database& database, const Statement& row, int column, const char* name) {
    return static_cast<std::int32_t>(number_in(database, row, column, name, 0, max_number));
}

/// Returns a stored standard deviation, by which fusion divides.
std::int32_t sd_in(const Database& database, const Statement& row, int column, const char* name) {
    return static_cast<std::int32_t>(number_in(database, row, column, name, 1, max_number));
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
            .at_mm = number_in(database, row, first + 2, "at_mm", 0, max_at_mm),
            .place_sd_mm = sd_in(database, row, first + 3, "place_sd_mm"),
            .size_um = number_in(database, row, first + 4, "size_um"),
            .sd_um = sd_in(database, row, first + 5, "sd_um"),
            .length_mm = number_in(database, row, first + 6, "length_mm")};
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
            .passes = number_in(database, row, first + event_column_count, "passes"),
            .passes_over = number_in(database, row, first + event_column_count + 1, "passes_over"),
            .vehicles = number_in(database, row, first + event_column_count + 2, "vehicles"),
            .first_seen_ms = known_utc_ms(row, first + event_column_count + 3),
            .last_seen_ms = known_utc_ms(row, first + event_column_count + 4)};
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
