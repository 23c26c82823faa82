#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/conflation/network_conflation.hpp"
#include "mapping/fusion/fusion.hpp"
#include "mapping/fusion/segment_record.hpp"
#include "mapping/network/road_network.hpp"
#include "mapping/passes/chunk_trace.hpp"
#include "mapping/passes/pass.hpp"
#include "mapping/surveys/control_section.hpp"
#include "storage/sqlite/lock_wait.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/privacy/privacy_profile.hpp"
#include "storage/store/privacy/publication.hpp"
#include "storage/store/schema/maintenance_records.hpp"
#include "storage/store/schema/segment_filter.hpp"
#include "storage/store/schema/store_records.hpp"
#include "storage/store/schema/usage_records.hpp"

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Road database that collects the passes of many cars in one GeoPackage file
/// (docs/reference/database.md). Each call that writes is one atomic transaction, durable on
/// return; only refresh() takes several, so that other writers get their turn, and resumes after an
/// interruption.
///
/// Readers see the last commit; readers and the writer do not wait for each other.
///
/// \throws InputError  from every call, if the file is missing, not a road database, locked by an
///                     idle program, or not writable (the message names the file and the cause).
class RoadStore {
public:
    /// Creates a database with the segments of a network, and its key
    /// (storage/store/privacy/privacy_key.hpp); an existing key file is used.
    ///
    /// \throws InputError  if the file exists. Nothing remains after a failure.
    static RoadStore create(const std::filesystem::path& file,
                            const RoadNetwork& roads,
                            const StoreSettings& settings,
                            const Progress& progress = {});

    enum class Access { read, write };
    /// Opens a database.
    ///
    /// \param wait_policy  rules for waiting while another process writes, from opening on; its
    ///                     stop token ends the wait, without the write, and also interrupts
    ///                     reading. By default, it waits for as long as the other process makes
    ///                     progress.
    /// \param reader  audience for which the database is read; writers see everything.
    static RoadStore open(const std::filesystem::path& file,
                          Access access,
                          LockWaitPolicy wait_policy = {},
                          Reader reader = Reader::anyone);

    RoadStore(RoadStore&&) noexcept;
    RoadStore& operator=(RoadStore&&) noexcept;
    ~RoadStore();

    const StoreSettings& settings() const;

    const std::filesystem::path& file() const;

    /// Tests whether the key of the database lies beside it and is readable by this user. The
    /// holder of the key is the operator, who sees unpublished data of a crowd database.
    bool is_operator() const { return key() != nullptr; }

    /// Key of the database; null without it. open() throws InputError if the key file belongs to
    /// another database.
    const PrivacyKey* key() const;

    /// Creates a new key if there is none; add_trips() does so when it has to name a car.
    /// \returns true if cars of the database were named under a lost key: cars imported from now on
    /// cannot be linked to them.
    bool make_missing_key();

    /// Tests whether all data read here comes from the latest publication of a crowd database.
    bool shows_published_alone() const;

    /// Latest publication; `std::nullopt` if nothing was published yet.
    std::optional<Publication> latest_publication() const;

    /// Makes this month's publication of a crowd database, from passes of at least five cars per
    /// value (mapping/privacy/release_batches.hpp), in one transaction. Only published data leaves
    /// the database until the next publication.
    ///
    /// \param roads  network of the database.
    /// \throws InputError  if it is not a crowd database, the caller is not its operator, or this
    ///                     month's publication exists.
    Published
    publish(const RoadNetwork& roads, std::int64_t now_utc_ms, const Progress& progress = {});

    /// Turns a database of own cars into a crowd database, irreversibly: removes the data near the
    /// ends and long stops of all trips and overwrites the bytes, in one transaction.
    ///
    /// \throws InputError  if it is already one, or its roads were traced from trips.
    CrowdMade make_crowd(const Progress& progress = {});
    /// Checks at the end of reading that the data is current.
    ///
    /// \throws InputError  if the file was removed or replaced since it was opened.
    void expect_in_place() const;

    /// Network of this database, from which its segments are cut, built from the stored ways.
    /// load_or_build_network (storage/networks/network_file.hpp) is faster.
    RoadNetwork roads() const;

    /// SHA-256 of the ways, in hex digits.
    std::string network_hash() const;

    /// Replaces the network and begins a new generation: passes and traces move to their roads in
    /// the new network (mapping/transfer/transferred_passes.hpp), and the affected chunks are
    /// fused. Runs in one transaction: readers see the old roads until it is committed. Has no
    /// effect if the ways are equal.
    ///
    /// \param before  roads().
    /// \param change  from `before` to `after`.
    /// \throws InputError  if hardly any road is the same, or the network of the database was
    ///                     replaced since it was opened; the database is unchanged. Instances
    ///                     opened before the replacement then fail in add_trip().
    NetworkUpdate update_network(const RoadNetwork& before,
                                 const RoadNetwork& after,
                                 const NetworkChange& change,
                                 const NetworkSource& source,
                                 const Progress& progress = {});

    bool contains_trip(const std::string& sha256) const;

    /// Adds a trip. \returns false, without any change, if the trip is already stored or was
    /// forgotten.
    bool add_trip(const TripRecord& trip,
                  std::span<const Pass> passes,
                  std::span<const RoughnessTrace> traces = {},
                  const std::optional<std::span<const PassEvent>>& events = {});

    /// Adds many trips, which is faster: all of them or, on failure, none. \returns for each trip
    /// whether it is new.
    std::vector<bool> add_trips(std::span<const NewTrip> trips);

    /// Records the start of an import in a journal.
    ///
    /// \param name  identifies the request, so that a repeated request finds its journal entry.
    /// \returns the progress of an import of that name that started and did not finish: it was
    /// killed, stopped, or is still running.
    std::optional<OpenImport> begin_import(const std::string& name, std::size_t trips_asked);

    /// Removes the journal entry of a finished import.
    void end_import(const std::string& name);

    /// Aligns and fuses the passes of every chunk that has passes newer than its segment states
    /// (mapping/alignment/alignment.hpp, mapping/fusion/fusion.hpp), by the rules of the current
    /// generation. \returns the number of segments with new passes.
    std::size_t refresh(const Progress& progress = {});

    /// Calibrates the cars against each other from their readings of the same roads, and estimates
    /// the components of their errors. With `keep`, and if any car could be calibrated, begins a
    /// generation with these rules and all passes fused by them, in one transaction: readers see
    /// the old values until then. Like all calls that follow, it computes in shadow tables and
    /// locks out other writers only to apply the result; trips imported meanwhile are fused by the
    /// new rules, but do not enter the calibration.
    CalibrationReport calibrate(bool keep, const Progress& progress = {});

    /// Stages the new results of a trip of the database, invisible until commit_staged() and
    /// discarded with this object. \returns false if there is no such trip.
    bool stage_trip(const TripRecord& trip,
                    std::span<const Pass> passes,
                    std::span<const RoughnessTrace> traces,
                    const std::optional<std::span<const PassEvent>>& events = {});

    /// Begins a generation in which the staged trips replace their former results and the other
    /// trips are unchanged, in one transaction. Calibrated cars are recalibrated from the trips
    /// used before.
    ///
    /// \param how  description for the audit.
    Reprocessed commit_staged(std::string_view how, const Progress& progress = {});

    /// Deletes trips and everything derived from them, in one transaction: passes, states, and
    /// records of values that they changed. The result is the database that never contained them;
    /// if cars were calibrated from them, the cars are recalibrated from the others. A tombstone of
    /// each trip remains, by which it is recognised (docs/reference/database.md). Bytes are
    /// overwritten.
    ///
    /// \throws InputError  if a name matches no trip or vehicle; nothing is changed.
    Forgotten forget(const ForgetRequest& request, const Progress& progress = {});

    /// Tests whether the trip was forgotten; add_trip() skips such trips.
    bool has_forgotten(const std::string& sha256) const;

    /// Lets a forgotten trip be imported again.
    void readmit(const std::string& sha256);

    /// Sets the time, ms since 1970 UTC, from which passes over these segments count; older and
    /// undated passes belong to a former surface. `std::nullopt` lets all passes count. Fuses the
    /// segments, in one transaction. \returns how many of them the database contains.
    std::size_t set_valid_from(std::span<const SegmentKey> segments,
                               const std::optional<std::int64_t>& from_ms,
                               std::string_view reason,
                               const Progress& progress = {});

    /// Segments with such a time, in the order of keys.
    std::vector<ValidSince> valid_since() const;

    /// Log of all operations that changed values, oldest first.
    std::vector<AuditEntry> audit() const;

    /// Times and causes of the changes of a segment's value, oldest first.
    std::vector<NumberChange> changes(const SegmentKey& key) const;

    /// Calibrated cars, in the order of cars().
    std::vector<CalibratedCar> calibrated_cars() const;

    /// Visits segments in the order of keys (way, forward before backward, index), of the ranges,
    /// or worst first, all of one snapshot.
    ///
    /// States of a period are fused only from its passes, aligned only by the traces of their
    /// drives, as in a database without other passes.
    void visit(const SegmentFilter& filter,
               const std::function<void(const SegmentRecord&)>& visit,
               StateDetail detail = StateDetail::full) const;

    /// Visits the same segments in the same order, faster: only with the values shown on maps.
    void visit_summaries(const SegmentFilter& filter,
                         const std::function<void(const SegmentSummary&)>& visit) const;

    /// Potholes and other events on the segments of a filter, fused over passes
    /// (mapping/events/event_fusion.hpp), in the order of keys and along the way. With a period,
    /// only passes within it are used, and count as passes over the place.
    ///
    /// \throws InputError  for a period of a publication, which has no events by month.
    std::vector<EventRecord> events(const SegmentFilter& filter) const;

    /// Passes over a segment, in the order of (trip hash, occurrence).
    std::vector<HistoricPass> history(const SegmentKey& key) const;

    StoreInfo info() const;

    ObservedPeriod seen() const;

    /// Lengths with each direction counted, in the order of (highway, class from smooth to rough).
    std::vector<RoadClassLength> road_class_lengths() const;

    /// Mean speed of the cars' passes over each segment, km/h; segments without one are missing.
    std::map<SegmentKey, double> mean_speeds_kmh() const;

    /// Days with dated trips, in order.
    std::vector<DailyUsage> day_uses() const;

    /// Cars in the order of their first appearance: by the start of their first dated trip, then by
    /// the smallest hash of their trips. The order does not depend on the key. "unknown" is last.
    std::vector<std::string> cars() const;

    /// In the order of (cars(), model, method).
    std::vector<VehicleUse> vehicle_uses() const;

    /// Counts of log rows that were not used, by reason; trips of version 0.1 have none.
    std::map<std::string, std::size_t> row_reasons() const;

    /// Reference surveys, in the order of (name, hash).
    std::vector<SurveyUse> surveys() const;

    /// Readings of reference surveys, in the order of (segment, survey, occurrence), without the
    /// polylines of the segments.
    std::vector<ReferenceReading> reference_readings() const;

    /// Stores sections of known roughness, replacing those of the same name.
    void put_control_sections(std::span<const ControlSection> sections);

    /// Control sections in the order of their names.
    std::vector<ControlSection> control_sections() const;

    /// Number of segments whose new passes are not yet fused, as in StoreInfo::waiting, but faster.
    std::size_t waiting() const;

    /// Summary of the alignment of passes, as in StoreInfo::laid, but faster.
    AlignmentSummary laid() const;

    /// SHA-256 over passes and states as text: equal content gives an equal digest on any machine
    /// (docs/reference/database.md describes the text).
    std::string digest() const;

private:
    struct Impl;
    explicit RoadStore(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

} // namespace macadam
