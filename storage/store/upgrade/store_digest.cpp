#include "storage/store/upgrade/store_digest.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/sha256.hpp"
#include "storage/store/rows/event_row.hpp"
#include "storage/store/rows/segment_row.hpp"
#include "storage/store/schema/store_schema.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <optional>

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

std::string text_of(const std::optional<std::int64_t>& value) {
    return value ? fmt::format("{}", *value) : "-";
}

std::string columns_from(const Statement& row, int first, int last) {
    std::string text;
    for (int column = first; column < last; ++column) {
        text += " " + text_of(row.known_integer(column));
    }
    return text + "\n";
}

std::string state_line(const SegmentState& s) {
    const auto known = [](const std::optional<IriUm>& um) {
        return text_of(um ? std::optional<std::int64_t>{*um} : std::nullopt);
    };
    return fmt::format("state {} {} {} {} {} {} {} {:d} {} {} {} {} {} {} {} {} {}\n",
                       name_of(s.segment),
                       s.iri_um,
                       s.sd_um,
                       s.low_um,
                       s.high_um,
                       known(s.left_um),
                       known(s.right_um),
                       s.centre_only,
                       s.validity,
                       s.passes,
                       s.vehicles,
                       text_of(s.first_seen_ms),
                       text_of(s.last_seen_ms),
                       known(s.trend_um_per_year),
                       known(s.trend_sd_um_per_year),
                       text_of(s.change ? std::optional{s.change->utc_ms} : std::nullopt),
                       known(s.change ? std::optional{s.change->um} : std::nullopt));
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
        const auto* const kind = select.integer(2) != 0 ? "reference" : "pass";
        hash.add(fmt::format("{} {} {}", kind, select.text(0), select.text(1)) +
                 columns_from(select, 3, 3 + digest_column_count));
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
        hash.add(fmt::format("searched {}\n", searched.text(0)));
    }
    auto select = database.prepare(fmt::format(
        "SELECT segment.segment, trip.sha256, occurrence, {} FROM event"
        " CROSS JOIN segment ON segment.fid = event.segment"
        " CROSS JOIN trip ON trip.id = event.trip ORDER BY {}, trip.sha256, occurrence, number",
        event_columns,
        are_rows_in_order(database) ? "event.segment" : order_of_keys));
    while (select.step()) {
        hash.add(fmt::format("event {} {}", select.text(0), select.text(1)) +
                 columns_from(select, 2, 3 + event_column_count));
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
        hash.add(state_line(*record_in(select).state));
        ticks.add();
    }
    add_events(hash, database);
    return hash.hex();
}

} // namespace macadam
