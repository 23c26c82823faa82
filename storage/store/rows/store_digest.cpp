#include "storage/store/rows/store_digest.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/sha256.hpp"
#include "storage/store/rows/digest_text.hpp"
#include "storage/store/rows/event_row.hpp"
#include "storage/store/rows/segment_row.hpp"
#include "storage/store/schema/store_schema.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
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

/// Segments whose rows make up a digest, in the order of keys.
struct Scope {
    std::span<const ChunkRows> rows;
    bool is_part; ///< of the database
};

void add_passes(Sha256& hash, Database& database, const Scope& scope, Ticks& ticks) {
    auto select =
        database.prepare(fmt::format("SELECT segment.segment, trip.sha256,"
                                     " trip.reference_ppm IS NOT NULL, {} FROM pass"
                                     " CROSS JOIN segment ON segment.fid = pass.segment"
                                     " CROSS JOIN trip ON trip.id = pass.trip"
                                     " WHERE pass.segment >= ? AND pass.segment <= ?"
                                     " ORDER BY {}, trip.sha256, pass.occurrence",
                                     pass_columns,
                                     are_rows_in_order(database) ? "pass.segment" : order_of_keys));
    for (const auto& [first, last] : scope.rows) {
        for (select.bind(first, last); select.step(); ticks.add()) {
            hash.add(digest_line_of_pass(select.integer(2) != 0,
                                         select.text(0),
                                         select.text(1),
                                         numbers_of(select, 3, 3 + digest_column_count)));
        }
    }
}

void add_states(Sha256& hash, Database& database, const Scope& scope, Ticks& ticks) {
    auto select = database.prepare(
        fmt::format("SELECT {} FROM segment_state AS state CROSS JOIN segment"
                    " ON segment.fid = state.fid WHERE state.fid >= ? AND state.fid <= ?"
                    " ORDER BY {}",
                    record_columns,
                    are_rows_in_order(database) ? "state.fid" : order_of_keys));
    for (const auto& [first, last] : scope.rows) {
        for (select.bind(first, last); select.step(); ticks.add()) {
            hash.add(digest_line_of_state(*record_in(select).state));
        }
    }
}

void add_searches(Sha256& hash, Database& database, const Scope& scope) {
    const std::string searched = "SELECT trip.sha256 FROM event_search AS search"
                                 " CROSS JOIN trip ON trip.id = search.trip";
    if (!scope.is_part) {
        for (auto select = database.prepare(searched + " ORDER BY 1"); select.step();) {
            hash.add(digest_line_of_search(select.text(0)));
        }
        return;
    }
    std::set<std::string> trips;
    auto select = database.prepare(
        searched + " WHERE search.trip IN (SELECT trip FROM pass WHERE segment >= ?1 AND"
                   " segment <= ?2 UNION SELECT trip FROM trace WHERE strip = ?1)");
    for (const auto& [first, last] : scope.rows) {
        for (select.bind(first, last); select.step();) {
            trips.insert(select.text(0));
        }
    }
    for (const auto& trip : trips) {
        hash.add(digest_line_of_search(trip));
    }
}

/// Adds the trips that were searched for events, and the events. Databases before version 4 have
/// none, and a database without them has the digest that it had then.
void add_events(Sha256& hash, Database& database, const Scope& scope) {
    if (database.number("SELECT count(*) FROM sqlite_schema WHERE name = 'event'") == 0) {
        return;
    }
    add_searches(hash, database, scope);
    auto select = database.prepare(fmt::format(
        "SELECT segment.segment, trip.sha256, occurrence, {} FROM event"
        " CROSS JOIN segment ON segment.fid = event.segment"
        " CROSS JOIN trip ON trip.id = event.trip WHERE event.segment >= ? AND event.segment <= ?"
        " ORDER BY {}, trip.sha256, occurrence, number",
        event_columns,
        are_rows_in_order(database) ? "event.segment" : order_of_keys));
    for (const auto& [first, last] : scope.rows) {
        for (select.bind(first, last); select.step();) {
            hash.add(digest_line_of_event(
                select.text(0), select.text(1), numbers_of(select, 2, 3 + event_column_count)));
        }
    }
}

std::string digest_over(Database& database, const Progress& progress, const Scope& scope) {
    Sha256 hash;
    Ticks ticks{database, progress};
    add_passes(hash, database, scope, ticks);
    add_states(hash, database, scope, ticks);
    add_events(hash, database, scope);
    return hash.hex();
}

} // namespace

std::string digest_of(Database& database, const Progress& progress) {
    using Limits = std::numeric_limits<std::int64_t>;
    constexpr std::array all{ChunkRows{Limits::min(), Limits::max()}};
    return digest_over(database, progress, {all, false});
}

std::string
digest_of(Database& database, const Progress& progress, std::span<const ChunkRows> chunks) {
    return digest_over(database, progress, {chunks, true});
}

} // namespace macadam
