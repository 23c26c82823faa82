#include "storage/store/maintenance/network_move.hpp"

#include "estimator/common/error.hpp"
#include "mapping/transfer/transferred_passes.hpp"
#include "storage/geopackage/geopackage.hpp"
#include "storage/store/rows/event_row.hpp"
#include "storage/store/rows/pass_writer.hpp"
#include "storage/store/rows/segment_row.hpp"
#include "storage/store/rows/segment_rowids.hpp"
#include "storage/store/schema/network_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {
namespace {

// Segments of removed ways, by the rows to which passes and traces refer.
constexpr const char* make_old_segments =
    "CREATE TEMP TABLE old_segment (fid INTEGER PRIMARY KEY, way_id INTEGER NOT NULL,"
    " direction TEXT NOT NULL, seq INTEGER NOT NULL)";

void expect_to_go_on(const Database& database, const Progress& progress) {
    if (progress.stop.stop_requested()) {
        throw InputError{
            fmt::format("{}: interrupted; the database is unchanged", database.file().string())};
    }
}

/// Removes the segments of removed ways and remembers their rows.
void set_old_segments_aside(Database& database, const SegmentCorrespondences& correspondences) {
    database.run(make_old_segments);
    auto note = database.prepare("INSERT INTO temp.old_segment SELECT fid, way_id, direction, seq"
                                 " FROM segment WHERE way_id = ?");
    auto remove = database.prepare("DELETE FROM segment WHERE way_id = ?");
    for (std::uint32_t i = 0; i < way_count(correspondences.before()); ++i) {
        const auto id = correspondences.before().ways[i].id;
        if (!correspondences.is_kept(id)) {
            note.run(id);
            remove.run(id);
        }
    }
    database.run("DELETE FROM rtree_segment_geom WHERE id IN (SELECT fid FROM temp.old_segment)");
}

void write_new_segments(Database& database,
                        const SegmentCorrespondences& correspondences,
                        const Progress& progress) {
    std::vector<bool> is_kept;
    for (std::uint32_t i = 0; i < way_count(correspondences.after()); ++i) {
        is_kept.push_back(correspondences.is_kept(correspondences.after().ways[i].id));
    }
    const auto last = database.number("SELECT coalesce(max(fid), 0) FROM segment");
    write_segments(database, correspondences.after(), progress, is_kept);
    database
        .prepare("INSERT INTO rtree_segment_geom SELECT fid, ST_MinX(geom), ST_MaxX(geom),"
                 " ST_MinY(geom), ST_MaxY(geom) FROM segment WHERE fid > ?")
        .run(last);
}

// -------------------------------------------------------------------------------- passes, traces

std::vector<std::int64_t> trips_on_old_segments(Database& database) {
    auto select = database.prepare(
        "SELECT pass.trip FROM temp.old_segment AS old CROSS JOIN pass ON pass.segment = old.fid"
        " UNION SELECT trace.trip FROM temp.old_segment AS old"
        " CROSS JOIN trace ON trace.strip = old.fid ORDER BY 1");
    std::vector<std::int64_t> trips;
    while (select.step()) {
        trips.push_back(select.integer(0));
    }
    return trips;
}

std::vector<RoughnessCode> codes_in(std::string_view bytes) {
    return {bytes.begin(), bytes.end()};
}

/// Reads and removes the data of trips on old segments.
class OldReadings {
public:
    OldReadings(Database& database, double segment_length_m)
        : database_{&database}, segment_length_m_{segment_length_m},
          passes_{database.prepare(fmt::format(
              "SELECT old.way_id, old.direction, old.seq, pass.segment, {} FROM pass"
              " CROSS JOIN temp.old_segment AS old ON old.fid = pass.segment WHERE pass.trip = ?"
              " ORDER BY old.way_id, old.direction DESC, old.seq, pass.occurrence",
              pass_columns))},
          traces_{database.prepare(
              "SELECT old.way_id, old.direction, old.seq, trace.strip, trace.drive, trace.first_m,"
              " trace.place_sd_mm, trace.iri, trace.iri_left FROM trace"
              " CROSS JOIN temp.old_segment AS old ON old.fid = trace.strip WHERE trace.trip = ?"
              " ORDER BY old.way_id, old.direction DESC, old.seq, trace.drive")},
          events_{database.prepare(fmt::format(
              "SELECT old.way_id, old.direction, old.seq, event.occurrence, {} FROM event"
              " CROSS JOIN temp.old_segment AS old ON old.fid = event.segment WHERE event.trip = ?"
              " ORDER BY old.way_id, old.direction DESC, old.seq, event.occurrence, event.number",
              event_columns))},
          remove_events_{database.prepare("DELETE FROM event WHERE trip = ? AND segment IN"
                                          " (SELECT fid FROM temp.old_segment)")},
          remove_pass_{database.prepare(
              "DELETE FROM pass WHERE segment = ? AND trip = ? AND occurrence = ?")},
          remove_trace_{
              database.prepare("DELETE FROM trace WHERE strip = ? AND trip = ? AND drive = ?")} {}

    TripPasses take(std::int64_t trip) {
        TripPasses readings;
        take_events(trip, readings.events);
        std::vector<std::int64_t> rows; // rows of the passes' segments
        for (passes_.bind(trip); passes_.step();) {
            readings.passes.push_back(pass_in(passes_, 4, key_in(passes_, 0)));
            rows.push_back(passes_.integer(3));
        }
        passes_.reset();
        for (std::size_t i = 0; i < rows.size(); ++i) {
            remove_pass_.run(rows[i], trip, std::int64_t{readings.passes[i].occurrence});
        }
        rows.clear();
        for (traces_.bind(trip); traces_.step();) {
            readings.traces.push_back(
                {.chunk = chunk_of(key_in(traces_, 0), segment_length_m_),
                 .drive = static_cast<std::uint32_t>(traces_.integer(4)),
                 .first_m = static_cast<std::int32_t>(traces_.integer(5)),
                 .iri = codes_in(traces_.blob(7)),
                 .left = codes_in(traces_.blob(8)),
                 .place_sd_mm = static_cast<std::int32_t>(traces_.integer(6))});
            rows.push_back(traces_.integer(3));
        }
        traces_.reset();
        for (std::size_t i = 0; i < rows.size(); ++i) {
            remove_trace_.run(rows[i], trip, std::int64_t{readings.traces[i].drive});
        }
        return readings;
    }

private:
    void take_events(std::int64_t trip, std::vector<PassEvent>& events) {
        for (events_.bind(trip); events_.step();) {
            events.push_back(event_in(*database_,
                                      events_,
                                      4,
                                      key_in(events_, 0),
                                      static_cast<std::uint32_t>(events_.integer(3))));
        }
        events_.reset();
        remove_events_.run(trip);
    }

    const Database* database_;
    double segment_length_m_;
    Statement passes_;
    Statement traces_;
    Statement events_;
    Statement remove_events_;
    Statement remove_pass_;
    Statement remove_trace_;
};

MovedPasses move_readings(Database& database,
                          const SegmentCorrespondences& correspondences,
                          const Progress& progress) {
    const double segment_length_m = correspondences.before().segment_length_m;
    const auto trips = trips_on_old_segments(database);
    OldReadings old{database, segment_length_m};
    PassWriter writer{database, segments_per_chunk(segment_length_m), Destination::kept};
    MovedPasses moved;
    std::size_t done = 0;
    for (const auto trip : trips) {
        const auto now = transfer_passes(old.take(trip), correspondences);
        writer.write(trip, now.readings.passes, now.readings.traces, now.readings.events);
        moved.carried += now.moved;
        moved.lost += now.lost;
        moved.now += now.readings.passes.size();
        progress(++done, trips.size());
        expect_to_go_on(database, progress);
    }
    writer.flush();
    return moved;
}

// ----------------------------------------------------------------------------- what else they have

struct OldRow {
    std::int64_t fid;
    SegmentKey key;
};

/// Old segments that have a row in a table, of its column `column`.
std::vector<OldRow> old_rows_in(Database& database, const char* table, const char* column) {
    auto select = database.prepare(
        fmt::format("SELECT DISTINCT old.fid, old.way_id, old.direction, old.seq FROM"
                    " temp.old_segment AS old CROSS JOIN {} AS other ON other.{} = old.fid"
                    " ORDER BY old.fid",
                    table,
                    column));
    std::vector<OldRow> rows;
    while (select.step()) {
        rows.push_back({select.integer(0), key_in(select, 1)});
    }
    return rows;
}

/// Renames rows in place where a segment only got another key, to keep states and their history.
void rename_rows(Database& database,
                 const SegmentCorrespondences& correspondences,
                 const char* table,
                 const char* column) {
    SegmentRowids segments{
        database, std::int64_t{segments_per_chunk(correspondences.after().segment_length_m)}};
    auto rename =
        database.prepare(fmt::format("UPDATE {0} SET {1} = ?2 WHERE {1} = ?1", table, column));
    auto remove = database.prepare(fmt::format("DELETE FROM {} WHERE {} = ?", table, column));
    for (const auto& [fid, key] : old_rows_in(database, table, column)) {
        if (const auto correspondence = correspondences.unchanged(key)) {
            rename.run(fid, segments.row_of(correspondence->after));
        } else {
            remove.run(fid);
        }
    }
}

// Old segments of which earlier passes never count, because the map before cut them anew: no
// publication that knew them has a figure of them.
constexpr const char* recut_segments =
    "SELECT until.segment FROM temp.old_segment AS old"
    " CROSS JOIN published_until AS until ON until.segment = old.fid"
    " WHERE (SELECT min(figure.publication) FROM published_figure AS figure"
    " WHERE figure.segment = old.fid) > (SELECT max(number) FROM publication"
    " WHERE last_segment < old.fid)";

/// Withdraws what was published of segments that an earlier map cut anew. Under a new row, they
/// would be taken for segments all of whose passes count.
void withdraw_recut_segments(Database& database) {
    database.run(fmt::format("CREATE TEMP TABLE recut_segment AS {}", recut_segments));
    for (const auto* column : {"published_state.fid",
                               "published_until.segment",
                               "published_pending.segment",
                               "published_figure.segment"}) {
        const std::string_view name{column};
        database.run(fmt::format("DELETE FROM {} WHERE {} IN (SELECT segment FROM"
                                 " temp.recut_segment)",
                                 name.substr(0, name.find('.')),
                                 name));
    }
    database.run("DROP TABLE temp.recut_segment");
}

/// Moves the dates from which passes count. A new segment inherits a date that applied to half of
/// it, or the later of two dates.
void move_valid_from(Database& database, const SegmentCorrespondences& correspondences) {
    SegmentRowids segments{
        database, std::int64_t{segments_per_chunk(correspondences.after().segment_length_m)}};
    auto add = database.prepare(
        "INSERT INTO valid_from SELECT ?2, from_ms FROM valid_from WHERE segment = ?1"
        " ON CONFLICT (segment) DO UPDATE SET from_ms = max(from_ms, excluded.from_ms)");
    auto remove = database.prepare("DELETE FROM valid_from WHERE segment = ?");
    for (const auto& [fid, key] : old_rows_in(database, "valid_from", "segment")) {
        for (const auto& correspondence : correspondences.of(key)) {
            if (length_m(correspondence.after_m) >= length_m(correspondence.whole_m) / 2) {
                add.run(fid, segments.row_of(correspondence.after));
            }
        }
        remove.run(fid);
    }
}

/// Moves control sections and removes those whose road is gone. \returns the names of the removed
/// ones.
std::vector<std::string> move_control_sections(Database& database,
                                               const SegmentCorrespondences& correspondences) {
    struct Section {
        std::string name;
        DirectedPart part;
    };
    constexpr double mm_per_m = 1000;
    std::vector<Section> sections;
    auto select = database.prepare(
        "SELECT name, way_id, direction, from_mm, to_mm FROM control_section ORDER BY name");
    while (select.step()) {
        const bool forward = select.text(2) == "forward";
        const double from_m = static_cast<double>(select.integer(3)) / mm_per_m;
        const double to_m = static_cast<double>(select.integer(4)) / mm_per_m;
        sections.push_back({select.text(0),
                            {select.integer(1),
                             forward,
                             station_m(forward, forward ? from_m : to_m),
                             station_m(forward, forward ? to_m : from_m)}});
    }
    auto move = database.prepare("UPDATE control_section SET way_id = ?2, direction = ?3,"
                                 " from_mm = ?4, to_mm = ?5 WHERE name = ?1");
    auto remove = database.prepare("DELETE FROM control_section WHERE name = ?");
    std::vector<std::string> lost;
    for (const auto& [name, part] : sections) {
        if (correspondences.is_kept(part.way_id)) {
            continue;
        }
        if (const auto now = correspondences.stretch(part)) {
            const double a = std::abs(now->from_station_m);
            const double b = std::abs(now->to_station_m);
            move.run(name,
                     now->way_id,
                     now->forward ? "forward" : "backward",
                     std::int64_t{std::llround(mm_per_m * std::min(a, b))},
                     std::int64_t{std::llround(mm_per_m * std::max(a, b))});
        } else {
            remove.run(name);
            lost.push_back(name);
        }
    }
    return lost;
}

void remove_what_is_made_anew(Database& database) {
    for (const auto* table : {"strip_state", "strip_dirty"}) {
        database.run(
            fmt::format("DELETE FROM {} WHERE strip IN (SELECT fid FROM temp.old_segment)", table));
    }
    database.run("DELETE FROM segment_dirty WHERE segment IN (SELECT fid FROM temp.old_segment)");
}

} // namespace

MovedPasses move_to_network(Database& database,
                            const SegmentCorrespondences& correspondences,
                            const Progress& progress) {
    database.run("PRAGMA defer_foreign_keys = ON");
    remove_index_triggers(database, "segment");
    set_old_segments_aside(database, correspondences);
    update_ways(database, correspondences.before(), correspondences.after());
    write_new_segments(database, correspondences, {.report = {}, .stop = progress.stop});
    add_index_triggers(database, "segment");
    auto moved = move_readings(database, correspondences, progress);
    moved.lost_sections = move_control_sections(database, correspondences);
    rename_rows(database, correspondences, "segment_state", "fid");
    rename_rows(database, correspondences, "state_change", "segment");
    withdraw_recut_segments(database);
    rename_rows(database, correspondences, "published_state", "fid");
    rename_rows(database, correspondences, "published_until", "segment");
    rename_rows(database, correspondences, "published_pending", "segment");
    rename_rows(database, correspondences, "published_figure", "segment");
    database.run("DELETE FROM published_event WHERE segment IN (SELECT fid FROM temp.old_segment)");
    move_valid_from(database, correspondences);
    remove_what_is_made_anew(database);
    database.run("DROP TABLE temp.old_segment");
    return moved;
}

} // namespace macadam
