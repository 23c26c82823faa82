#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/conflation/network_conflation.hpp"
#include "mapping/network/road_network.hpp"
#include "mapping/surveys/control_section.hpp"
#include "storage/store/records/maintenance_records.hpp"
#include "storage/store/records/publication.hpp"
#include "storage/store/records/store_records.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

namespace macadam {

struct StoreConnection;

/// Maintains a road database: operations of its operator that change many values. Each call is one
/// atomic transaction, durable on return. Most compute in shadow tables and lock out other writers
/// only to apply the result; readers see the old values until then.
///
/// \throws InputError  from every call, if the file was removed, is locked by an idle program, or
///                     is not writable (the message names the file and the cause), and if a stop is
///                     requested; the database is unchanged.
class StoreMaintenance {
public:
    explicit StoreMaintenance(std::shared_ptr<StoreConnection> store) : store_{std::move(store)} {}

    /// Calibrates the cars against each other from their readings of the same roads, and estimates
    /// the components of their errors. If any car could be calibrated, begins a generation with
    /// these rules and all passes fused by them. Trips imported meanwhile are fused by the new
    /// rules, but do not enter the calibration.
    CalibrationReport calibrate(const Progress& progress = {});

    /// Stages the new results of a trip of the database, invisible until commit_staged() and
    /// discarded when the database is closed. \returns false if there is no such trip.
    bool stage_trip(const NewTrip& trip);

    /// Begins a generation in which the staged trips replace their former results and the other
    /// trips are unchanged. Calibrated cars are recalibrated from the trips used before.
    ///
    /// \param how  description for the audit.
    Reprocessed commit_staged(std::string_view how, const Progress& progress = {});

    /// Deletes trips and everything derived from them: passes, states, and records of values that
    /// they changed. The result is the database that never contained them; if cars were calibrated
    /// from them, the cars are recalibrated from the others. A tombstone of each trip remains, by
    /// which it is recognised (docs/reference/database.md). Bytes are overwritten.
    ///
    /// \throws InputError  if a name matches no trip or vehicle; nothing is changed.
    Forgotten forget(const ForgetRequest& request, const Progress& progress = {});

    /// Sets the time, ms since 1970 UTC, from which passes over these segments count; older and
    /// undated passes belong to a former surface. `std::nullopt` lets all passes count. Fuses the
    /// segments. \returns how many of them the database contains.
    std::size_t set_valid_from(std::span<const SegmentKey> segments,
                               const std::optional<std::int64_t>& from_ms,
                               std::string_view reason,
                               const Progress& progress = {});

    /// Stores sections of known roughness, replacing those of the same name.
    void put_control_sections(std::span<const ControlSection> sections);

    /// Replaces the network and begins a new generation: passes and traces move to their roads in
    /// the new network (mapping/transfer/transferred_passes.hpp), and the affected chunks are
    /// fused. Has no effect if the ways are equal.
    ///
    /// \param before  StoreReader::roads().
    /// \param change  from `before` to `after`.
    /// \throws InputError  if hardly any road is the same, or the network of the database was
    ///                     replaced since it was opened; the database is unchanged. Instances
    ///                     opened before the replacement then fail in add_trips().
    NetworkUpdate update_network(const RoadNetwork& before,
                                 const RoadNetwork& after,
                                 const NetworkChange& change,
                                 const NetworkSource& source,
                                 const Progress& progress = {});

    /// Makes this month's publication of a crowd database, from passes of at least five cars per
    /// value (mapping/privacy/release_batches.hpp). Only published data leaves the database until
    /// the next publication.
    ///
    /// \param roads  network of the database.
    /// \throws InputError  if it is not a crowd database, the caller is not its operator, or this
    ///                     month's publication exists.
    Published
    publish(const RoadNetwork& roads, std::int64_t now_utc_ms, const Progress& progress = {});

    /// Turns a database of own cars into a crowd database, irreversibly: removes the data near the
    /// ends and long stops of all trips and overwrites the bytes.
    ///
    /// \throws InputError  if it is already one, or its roads were traced from trips.
    CrowdMade make_crowd(const Progress& progress = {});

private:
    std::shared_ptr<StoreConnection> store_;
};

} // namespace macadam
