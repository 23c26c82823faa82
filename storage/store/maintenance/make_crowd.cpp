#include "estimator/common/error.hpp"
#include "mapping/privacy/kept_passes.hpp"
#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/store/connection/store_connection.hpp"
#include "storage/store/fusion/dirty_fusion.hpp"
#include "storage/store/maintenance/store_maintenance.hpp"
#include "storage/store/privacy/crowd_trim.hpp"
#include "storage/store/rows/audit.hpp"
#include "storage/store/schema/network_rows.hpp"
#include "storage/store/schema/store_schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace macadam {
namespace {

struct CarTrip {
    std::int64_t row;
    std::string sha256;
    std::int64_t trimmed_mm; ///< by its recorder
};

std::vector<CarTrip> trips_of_cars(Database& database) {
    auto select = database.prepare(
        "SELECT id, sha256, trimmed_mm FROM trip WHERE reference_ppm IS NULL ORDER BY id");
    std::vector<CarTrip> trips;
    while (select.step()) {
        trips.push_back({select.integer(0), select.text(1), select.integer(2)});
    }
    return trips;
}

using DriveOverChunk = std::pair<std::int64_t, std::int64_t>; ///< chunk, drive

struct PassRow {
    std::int64_t segment;
    std::int64_t occurrence;
    std::int64_t covered_mm;
    std::optional<DriveOverChunk> drive;
};

/// Passes of one trip, in driving order.
struct PassesOfTrip {
    std::vector<PassRow> rows;
    std::vector<PassedSegment> passed;
};

/// Removes the data near the ends and stops of trips, as if it had never been imported.
class TripEraser {
public:
    TripEraser(Database& database, const PrivacyKey& key)
        : key_{&key}, select_{database.prepare(
                          "SELECT pass.segment, pass.occurrence, pass.t_ms, pass.covered_mm,"
                          " pass.drive, segment.strip, segment.from_m, segment.to_m, segment.geom"
                          " FROM pass CROSS JOIN segment ON segment.fid = pass.segment"
                          " WHERE pass.trip = ? ORDER BY pass.t_ms, pass.segment")},
          erase_pass_{database.prepare(
              "DELETE FROM pass WHERE segment = ? AND trip = ? AND occurrence = ?")},
          erase_events_{database.prepare(
              "DELETE FROM event WHERE segment = ? AND trip = ? AND occurrence = ?")},
          move_passes_{database.prepare("UPDATE pass SET t_ms = t_ms - ?2 WHERE trip = ?1")},
          traces_{database.prepare("SELECT strip, drive FROM trace WHERE trip = ?")},
          erase_trace_{
              database.prepare("DELETE FROM trace WHERE strip = ? AND trip = ? AND drive = ?")},
          put_trip_{database.prepare("UPDATE trip SET distance_mm = ?2, matched_mm = ?2,"
                                     " t0_utc_ms = CASE WHEN ?3 IS NULL THEN NULL"
                                     " ELSE t0_utc_ms + ?3 END WHERE id = ?1")} {}

    /// \returns the number of removed passes.
    std::size_t trim(const CarTrip& trip) {
        const auto passes = passes_of(trip.row);
        const auto kept = kept_passes(passes.passed, [&](std::size_t n) {
            const auto rule = crowd_trim(*key_);
            return rule.min_m + rule.random_m * rule.draw(trip.sha256, n);
        });
        std::int64_t kept_mm = 0;
        std::optional<std::int64_t> begin_ms;
        for (std::size_t i = 0; i < kept.size(); ++i) {
            if (kept[i]) {
                kept_mm += passes.rows[i].covered_mm;
                begin_ms = begin_ms.value_or(passes.passed[i].t_ms);
            } else {
                erase_pass_.run(passes.rows[i].segment, trip.row, passes.rows[i].occurrence);
                erase_events_.run(passes.rows[i].segment, trip.row, passes.rows[i].occurrence);
            }
        }
        erase_traces(trip.row, passes.rows, kept);
        put_trip_.run(trip.row, kept_mm, begin_ms);
        move_passes_.run(trip.row, begin_ms.value_or(0));
        return static_cast<std::size_t>(std::ranges::count(kept, false));
    }

private:
    PassesOfTrip passes_of(std::int64_t trip) {
        PassesOfTrip passes;
        for (select_.bind(trip); select_.step();) {
            const auto line = line_of_geometry(select_.blob(8));
            if (!is_line(line)) {
                throw InputError{"a segment has no valid line geometry; the database was "
                                 "modified by another program"};
            }
            const auto drive = select_.known_integer(4);
            passes.rows.push_back(
                {select_.integer(0),
                 select_.integer(1),
                 select_.integer(3),
                 drive ? std::optional{DriveOverChunk{select_.integer(5), *drive}} : std::nullopt});
            passes.passed.push_back({select_.integer(2),
                                     std::abs(select_.real(7) - select_.real(6)),
                                     line.front(),
                                     line.back()});
        }
        select_.reset();
        return passes;
    }

    /// Removes traces, except those between two others whose passes are all kept: at the ends of
    /// the kept part, a trace may reveal more than the passes.
    void erase_traces(std::int64_t trip,
                      const std::vector<PassRow>& rows,
                      const std::vector<bool>& kept) {
        std::map<DriveOverChunk, bool> stays;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const bool is_inside = i > 0 && i + 1 < rows.size() && kept[i - 1] && kept[i + 1];
            if (rows[i].drive) {
                const auto found = stays.try_emplace(*rows[i].drive, true).first;
                found->second = found->second && kept[i] && is_inside;
            }
        }
        std::vector<DriveOverChunk> going;
        for (traces_.bind(trip); traces_.step();) {
            const DriveOverChunk drive{traces_.integer(0), traces_.integer(1)};
            if (const auto found = stays.find(drive); found == stays.end() || !found->second) {
                going.push_back(drive);
            }
        }
        traces_.reset();
        for (const auto& [chunk, drive] : going) {
            erase_trace_.run(chunk, trip, drive);
        }
    }

    const PrivacyKey* key_;
    Statement select_;
    Statement erase_pass_;
    Statement erase_events_;
    Statement move_passes_;
    Statement traces_;
    Statement erase_trace_;
    Statement put_trip_;
};

/// Marks everything for fusion and deletes the recorded changes of values, which would reveal
/// removed data.
constexpr const char* begin_anew =
    "INSERT OR IGNORE INTO segment_dirty SELECT fid FROM segment_state;"
    "INSERT OR IGNORE INTO segment_dirty SELECT DISTINCT segment FROM pass;"
    "INSERT OR IGNORE INTO strip_dirty SELECT strip FROM strip_state;"
    "DELETE FROM state_change; DELETE FROM import_note;"
    "UPDATE meta SET value = 'crowd' WHERE key = 'privacy'";

} // namespace

CrowdMade StoreMaintenance::make_crowd(const Progress& progress) {
    auto& database = store_->database;
    const auto refuse = [&](std::string_view why) {
        throw InputError{fmt::format("{}: {}", database.file().string(), why)};
    };
    store_->make_missing_key();
    CrowdMade made;
    {
        Transaction all{database, Transaction::Kind::write};
        store_->settings = read_settings(database);
        if (store_->settings.privacy == PrivacyProfile::crowd) {
            refuse("is already a crowd database");
        }
        if (store_->settings.network_source == traced_network_source) {
            refuse("its roads were traced from trips and end where the trips end; expected a "
                   "database made from a map");
        }
        const auto trips = trips_of_cars(database);
        const double least_mm = 1000 * crowd_trim(*store_->key).min_m;
        TripEraser eraser{database, *store_->key};
        for (const auto& trip : trips) {
            if (progress.stop.stop_requested()) {
                refuse("interrupted; the database is unchanged");
            }
            if (static_cast<double>(trip.trimmed_mm) >= least_mm) { // as an import takes it
                ++made.trimmed_before;
            } else {
                ++made.trips;
                made.passes += eraser.trim(trip);
            }
            progress(made.trips + made.trimmed_before, trips.size());
        }
        database.run(begin_anew);
        replace_roughness_layer(database, PrivacyProfile::crowd);
        const auto audit =
            add_audit(database, "crowd", fmt::format("ends of {} trips taken out", made.trips));
        fuse_dirty_at_once(
            database, {store_->segments_per_chunk(), &store_->classes(), audit}, progress);
        all.commit();
    }
    store_->settings = read_settings(database);
    store_->written(progress);
    made.log_is_clean = database.checkpoint_wal();
    return made;
}

} // namespace macadam
