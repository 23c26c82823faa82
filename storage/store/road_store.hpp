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

/// Where the passes of many cars meet: one GeoPackage file (docs/reference/database.md). Each call
/// that writes is one transaction, all of it or nothing, on disk when it returns; only refresh()
/// takes several, so that others get their turn, and goes on where it was cut off.
///
/// Readers see the last commit and neither wait for a writer nor make it wait.
///
/// \throws InputError  from every call, if the file is missing, no store, kept locked by a
///                     program that does nothing with it, or cannot be written (the message names
///                     the file and the cause).
class RoadStore {
public:
    /// Makes a new store with the segments of a network, and its key
    /// (storage/store/privacy/privacy_key.hpp); a key that lies there already is taken. \throws
    /// InputError if the file exists; leaves nothing behind if it fails.
    static RoadStore create(const std::filesystem::path& file,
                            const RoadNetwork& roads,
                            const StoreSettings& settings,
                            const Progress& progress = {});

    enum class Access { read, write };
    /// \param patience  how it waits, from its opening on, while another process writes, and what
    /// ends the wait: what then was to be written is not. Without a word from here it waits as long
    /// as the other works. Its stop also ends what is read.
    /// \param reader  for whom a store is read; who writes it sees all.
    static RoadStore open(const std::filesystem::path& file,
                          Access access,
                          LockWaitPolicy wait_policy = {},
                          Reader reader = Reader::anyone);

    RoadStore(RoadStore&&) noexcept;
    RoadStore& operator=(RoadStore&&) noexcept;
    ~RoadStore();

    const StoreSettings& settings() const;

    const std::filesystem::path& file() const;

    /// Whether the key of the store lies beside it, for this user to read: who has it is the
    /// operator, and sees of a crowd more than is published.
    bool is_operator() const { return key() != nullptr; }

    /// Null for all others than the operator. \throws InputError from open(), if the key that lies
    /// there is of another store.
    const PrivacyKey* key() const;

    /// Makes a new key if none lies there; add_trips() does it where a car has to be named.
    /// \returns true if cars of the store were named under one that is gone: those that come from
    /// now on cannot be joined to them.
    bool make_missing_key();

    /// Whether all that is read here comes from the latest publication of a crowd.
    bool shows_published_alone() const;

    /// None if nothing was published yet.
    std::optional<Publication> latest_publication() const;

    /// Makes a crowd's publication of this month, from passes of at least five cars a figure
    /// (mapping/privacy/release_batches.hpp); it is what leaves the store until the next one. In
    /// one transaction. \param roads  the store's network.
    ///
    /// \throws InputError  if the store is no crowd's, the caller not its operator, or there is a
    /// publication of this month.
    Published
    publish(const RoadNetwork& roads, std::int64_t now_utc_ms, const Progress& progress = {});

    /// Makes a crowd's of a database of one's own cars, for good: takes out what is near the ends
    /// and long stops of its trips and overwrites the bytes, in one transaction.
    /// \throws InputError  if it is one, or its roads were traced from trips.
    CrowdMade make_crowd(const Progress& progress = {});
    /// To be asked at the end of what was read. \throws InputError  if the file was removed, or
    /// another one has taken its place, since it was opened.
    void expect_in_place() const;

    /// The network this store was made for; its segments are cut from it. Built from the ways that
    /// the store holds: load_or_build_network (storage/networks/network_file.hpp) has it quicker.
    RoadNetwork roads() const;

    /// SHA-256 of these ways, in hex digits.
    std::string network_hash() const;

    /// Puts another network in the place of the store's own, as a new generation: passes and traces
    /// go to where the new one has their roads (mapping/transfer/transferred_passes.hpp), and what
    /// they come to is fused. All of it is one transaction: readers see the old roads until it is
    /// done. Nothing is done if the ways are the same.
    ///
    /// \param before  roads(), \param change  between the two.
    /// \throws InputError  if hardly any road is the same, or the store has got another network
    /// since it was opened; it stays as it is. So does every later add_trip() of who opened it
    /// before.
    NetworkUpdate update_network(const RoadNetwork& before,
                                 const RoadNetwork& after,
                                 const NetworkChange& change,
                                 const NetworkSource& source,
                                 const Progress& progress = {});

    bool contains_trip(const std::string& sha256) const;

    /// \returns false, and changes nothing, if the trip is already there, or was forgotten.
    bool add_trip(const TripRecord& trip,
                  std::span<const Pass> passes,
                  std::span<const RoughnessTrace> traces = {});

    /// Many at once, which is quicker: all of them or, if one fails, none. \returns for each
    /// whether it is new.
    std::vector<bool> add_trips(std::span<const NewTrip> trips);

    /// Notes that an import has begun; `name` stands for what was asked, so that the same request
    /// finds its note again. \returns what an import of that name has done that began and did not
    /// end: it was killed, stopped, or still runs.
    std::optional<OpenImport> begin_import(const std::string& name, std::size_t trips_asked);

    /// Takes the note away: there is nothing left to do.
    void end_import(const std::string& name);

    /// Lays the passes of every chunk with passes newer than their segments' states on each other
    /// and fuses them (mapping/alignment/alignment.hpp, mapping/fusion/fusion.hpp) by the rules of
    /// the store's generation. \returns how many segments had new passes.
    std::size_t refresh(const Progress& progress = {});

    /// Finds how the cars read from what they read of the same roads, and of what their errors are
    /// made; with `keep`, and if any car could be calibrated, begins a generation with these rules
    /// and puts all passes fused by them in place, in one transaction: readers see the numbers of
    /// before until all are made. Like all that follow here, it works them out beside the store
    /// and keeps others from writing only while it puts them in place; trips that come in
    /// meanwhile are fused by the new rules, and no car is calibrated from them.
    CalibrationReport calibrate(bool keep, const Progress& progress = {});

    /// Lays aside what a trip of the store says now that it was worked out anew; nobody sees it
    /// before commit_staged(), and it goes with this object. \returns false if there is no such
    /// trip.
    bool stage_trip(const TripRecord& trip,
                    std::span<const Pass> passes,
                    std::span<const RoughnessTrace> traces);

    /// Begins a generation with the trips that were laid aside in place of what they said before,
    /// and the others as they were, in one transaction. Cars that were calibrated are calibrated
    /// anew from the trips that they were calibrated from. \param how  for the audit.
    Reprocessed commit_staged(std::string_view how, const Progress& progress = {});

    /// Takes trips and all that came of them out, in one transaction: passes, states, notes of
    /// numbers that they changed. What is left is what a store holds that never saw them; if cars
    /// were calibrated from them, they are calibrated anew from the others. Of each trip a mark is
    /// left by which it is known again (docs/reference/database.md). Bytes are overwritten.
    ///
    /// \throws InputError  if there is no trip or vehicle of a name; nothing is changed.
    Forgotten forget(const ForgetRequest& request, const Progress& progress = {});

    /// Whether the trip was here and was forgotten; add_trip() leaves it out.
    bool has_forgotten(const std::string& sha256) const;

    /// Lets a forgotten trip in again.
    void readmit(const std::string& sha256);

    /// From that time on, ms since 1970 UTC, passes speak of these segments; older ones, and
    /// undated ones, are of a road that is no more. Nothing: all do. Fuses them, in one
    /// transaction. \returns how many of them the store has.
    std::size_t set_valid_from(std::span<const SegmentKey> segments,
                               const std::optional<std::int64_t>& from_ms,
                               std::string_view reason,
                               const Progress& progress = {});

    /// In the order of keys.
    std::vector<ValidSince> valid_since() const;

    /// All that was done that changed numbers, oldest first.
    std::vector<AuditEntry> audit() const;

    /// When and why the number of a segment changed, oldest first.
    std::vector<NumberChange> changes(const SegmentKey& key) const;

    /// How cars of the store are calibrated: in the order of cars(), only those that are.
    std::vector<CalibratedCar> calibrated_cars() const;

    /// In the order of keys (way, forward before backward, index), of the ranges, or worst first.
    /// All is of one moment.
    ///
    /// States of a period are fused from its passes alone, laid on each other by the traces of
    /// their drives alone: as in a store that knows no other passes.
    void visit(const SegmentFilter& filter,
               const std::function<void(const SegmentRecord&)>& visit,
               StateDetail detail = StateDetail::full) const;

    /// The same segments in the same order, in less time: only what a map shows of them.
    void visit_summaries(const SegmentFilter& filter,
                         const std::function<void(const SegmentSummary&)>& visit) const;

    /// Passes over one segment, in the order of (trip hash, occurrence).
    std::vector<HistoricPass> history(const SegmentKey& key) const;

    StoreInfo info() const;

    ObservedPeriod seen() const;

    /// Each direction counted; in the order of (highway, class from smooth to rough).
    std::vector<RoadClassLength> road_class_lengths() const;

    /// Days with a dated trip, in order.
    std::vector<DailyUsage> day_uses() const;

    /// Cars in the order in which they were first there: by the start of their first dated trip,
    /// then by the least hash of their trips. It does not depend on the key. "unknown" is last.
    std::vector<std::string> cars() const;

    /// In the order of (cars(), model, method).
    std::vector<VehicleUse> vehicle_uses() const;

    /// Why rows of the trips' logs entered no estimate; trips of version 0.1 did not tell.
    std::map<std::string, std::size_t> row_reasons() const;

    /// Reference surveys, in the order of (name, hash).
    std::vector<SurveyUse> surveys() const;

    /// In the order of (segment, survey, occurrence). Lines of segments are left out.
    std::vector<ReferenceReading> reference_readings() const;

    /// Keeps stretches of known roughness; those of the same name are replaced.
    void put_control_sections(std::span<const ControlSection> sections);

    /// In the order of their names.
    std::vector<ControlSection> control_sections() const;

    /// Segments whose new passes are not yet fused, as StoreInfo::waiting; quick.
    std::size_t waiting() const;

    /// What laying passes on each other found, as StoreInfo::laid; quick.
    AlignmentSummary laid() const;

    /// SHA-256 over passes and states as text: the same content gives the same digest on any
    /// machine (docs/reference/database.md says how the text is made).
    std::string digest() const;

private:
    struct Impl;
    explicit RoadStore(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

} // namespace macadam
