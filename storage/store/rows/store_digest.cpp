#include "storage/store/rows/store_digest.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/sha256.hpp"
#include "storage/store/rows/digest_text.hpp"
#include "storage/store/rows/event_row.hpp"
#include "storage/store/rows/segment_row.hpp"
#include "storage/store/schema/store_schema.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {
namespace {

/// Reports progress at a fixed interval of rows.
class Ticks {
public:
    Ticks(Database& database, const Progress& progress)
        : database_{&database}, progress_{&progress} {
        if (progress.report) {
            whole_ = database.number("SELECT (SELECT count(*) FROM pass) +"
                                     " (SELECT count(*) FROM segment_state)");
        }
    }

    void add() {
        constexpr std::int64_t rows = 10'000;
        if (++done_ % rows == 0) {
            if (progress_->stop.stop_requested()) {
                throw InputError{fmt::format("{}: interrupted; the database is unchanged",
                                             database_->file().string())};
            }
            (*progress_)(static_cast<std::size_t>(done_), static_cast<std::size_t>(whole_));
        }
    }

private:
    Database* database_;
    const Progress* progress_;
    std::int64_t whole_ = 0;
    std::int64_t done_ = 0;
};

std::vector<std::optional<std::int64_t>> numbers_of(const Statement& row, int first, int last) {
    std::vector<std::optional<std::int64_t>> numbers;
    for (int column = first; column < last; ++column) {
        numbers.push_back(row.known_integer(column));
    }
    return numbers;
}

void add_passes(Sha256& hash, Database& database, Ticks& ticks) {
    auto select =
        database.prepare(fmt::format("SELECT segment.segment, trip.sha256,"
                                     " trip.reference_ppm IS NOT NULL, {} FROM pass"
                                     " CROSS JOIN segment ON segment.fid = pass.segment"
                                     " CROSS JOIN trip ON trip.id = pass.trip"
                                     " ORDER BY {}, trip.sha256, pass.occurrence",
                                     pass_columns,
                                     are_rows_in_order(database) ? "pass.segment" : order_of_keys));
    while (select.step()) {
        hash.add(digest_line_of_pass(select.integer(2) != 0,
                                     select.text(0),
                                     select.text(1),
                                     numbers_of(select, 3, 3 + digest_column_count)));
        ticks.add();
    }
}

/// Adds the trips that were searched for events, and the events. Databases before version 4 have
/// none, and a database without them has the digest that it had then.
void add_events(Sha256& hash, Database& database) {
    if (database.number("SELECT count(*) FROM sqlite_schema WHERE name = 'event'") == 0) {
        return;
    }
    auto searched = database.prepare("SELECT trip.sha256 FROM event_search AS search"
                                     " CROSS JOIN trip ON trip.id = search.trip ORDER BY 1");
    while (searched.step()) {
        hash.add(digest_line_of_search(searched.text(0)));
    }
    auto select = database.prepare(fmt::format(
        "SELECT segment.segment, trip.sha256, occurrence, {} FROM event"
        " CROSS JOIN segment ON segment.fid = event.segment"
        " CROSS JOIN trip ON trip.id = event.trip ORDER BY {}, trip.sha256, occurrence, number",
        event_columns,
        are_rows_in_order(database) ? "event.segment" : order_of_keys));
    while (select.step()) {
        hash.add(digest_line_of_event(
            select.text(0), select.text(1), numbers_of(select, 2, 3 + event_column_count)));
    }
}

} // namespace

std::string digest_of(Database& database, const Progress& progress) {
    Sha256 hash;
    Ticks ticks{database, progress};
    add_passes(hash, database, ticks);
    auto select = database.prepare(
        fmt::format("SELECT {} FROM segment JOIN segment_state AS state ON state.fid = segment.fid"
                    " ORDER BY {}",
                    record_columns,
                    are_rows_in_order(database) ? "segment.fid" : order_of_keys));
    while (select.step()) {
        hash.add(digest_line_of_state(*record_in(select).state));
        ticks.add();
    }
    add_events(hash, database);
    return hash.hex();
}

} // namespace macadam
