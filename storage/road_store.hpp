#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/alignment.hpp"
#include "mapping/change_summary.hpp"
#include "mapping/control_section.hpp"
#include "mapping/fusion.hpp"
#include "mapping/iri_class.hpp"
#include "mapping/network_change.hpp"
#include "mapping/pass.hpp"
#include "mapping/road_network.hpp"
#include "mapping/segment_record.hpp"
#include "mapping/strip_trace.hpp"
#include "storage/lock_wait.hpp"
#include "storage/privacy_key.hpp"
#include "storage/privacy_profile.hpp"
#include "storage/publication.hpp"
#include "storage/segment_filter.hpp"
#include "storage/store_upkeep.hpp"
#include "storage/store_use.hpp"

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

/// What a store is made with and keeps.
struct StoreSettings {
    double segment_length_m = 20;
    std::string class_table = "fhwa";
    std::string network_source; ///< file name of the map, or "traced from the trips"
    std::string attribution;    ///< whom a picture of these roads must name
    PrivacyProfile privacy = PrivacyProfile::own;
};

/// Instead of a map's name: no map, roads from `init --trace`.
inline constexpr std::string_view traced_network_source = "traced from the trips";

/// Instead of a model's name: the user's own, whose name would tell the car.
inline constexpr std::string_view own_file_model = "own file";

/// That a trip is none, but a survey with better instruments.
struct ReferenceNote {
    std::int32_t relative_sd_ppm; ///< its stated accuracy, of what it reads
    std::int32_t row_mm;          ///< the median length of its rows
};

/// What the store keeps of a trip: no positions, no log.
struct TripRecord {
    std::string sha256; ///< unique
    std::string trip_id;
    std::string
        vehicle_id; ///< kept only as a pseudonym, also within the two names; "" = not stated
    std::string file_name;
    std::optional<std::int64_t> t0_utc_ms; ///< nothing: undated
    std::string vehicle_model; ///< name of the built-in Vehicle that was used, or own_file_model
    std::string method;
    std::int64_t distance_mm = 0;
    std::int64_t matched_mm = 0;
    std::size_t rows_read = 0;
    std::size_t rows_used = 0;
    std::map<std::string, std::size_t> row_reasons{}; ///< why the others were not

    std::optional<ReferenceNote> reference{}; ///< of a survey: trip_id is its name, t0_utc_ms its
                                              ///< day, and there is no vehicle
};

/// A trip with all that it says of the roads.
struct NewTrip {
    const TripRecord* trip;
    std::span<const Pass> passes;
    std::span<const StripTrace> traces;
    bool take_back = false; ///< comes in also if it was forgotten
};

/// One pass with where it came from: a line of a segment's history.
struct PassRecord {
    Pass pass;
    std::string trip_sha256;
    std::string vehicle; ///< pseudonym; "" of a reference
    std::optional<std::int64_t> utc_ms;
    std::optional<std::string> reference{}; ///< name of the survey, if it is one

    /// How far behind its own place the road lay that the trip read there, by what others read; as
    /// the fusion takes it. Nothing: the pass has no trace.
    std::optional<double> lag_m{};
    LagFinding finding = LagFinding::alone; ///< why it is so, or 0
};

/// What a survey says of a segment.
struct ReferenceReading {
    Segment segment;
    std::string highway;
    Pass pass;
    std::size_t survey; ///< of surveys()
};

/// An import that began and did not end.
struct OpenImport {
    std::size_t trips_asked;
    std::size_t trips_added; ///< to the store, by anyone, since it began
};

struct StoreInfo {
    StoreSettings settings;
    std::size_t trips = 0; ///< of cars, as all counts of trips and passes
    std::size_t undated_trips = 0;
    std::size_t passes = 0;
    std::size_t lateral_passes = 0;    ///< of them, from lateral vibration alone
    std::vector<std::string> vehicles; ///< pseudonyms, as RoadStore::cars()
    std::size_t segments = 0;
    std::size_t segments_with_passes = 0;     ///< of cars or references
    double km = 0;                            ///< of segments with passes
    std::optional<Publication> publication{}; ///< the latest of a crowd
    bool published_alone = false; ///< all here is from it; of trips and passes at least so many
    double network_km = 0;        ///< of all segments, each direction counted
    std::vector<ClassLength> classes;
    std::optional<std::int64_t> first_seen_ms;
    std::optional<std::int64_t> last_seen_ms;
    std::size_t waiting = 0; ///< segments whose new passes are not yet fused
    LaySummary laid;         ///< of all strips that were fused; the median of the strips' medians
    int generation = 1;
    GeoBox box; ///< of segments with passes; of all if there are none
};

/// Where a network is from.
struct NetworkSource {
    std::string name;        ///< as StoreSettings::network_source
    std::string attribution; ///< as in StoreSettings
};

/// What an update of the network did.
struct NetworkUpdate {
    ChangeSummary roads;
    std::size_t passes_kept = 0;    ///< on ways that were kept
    std::size_t passes_carried = 0; ///< old ones of which something is left
    std::size_t passes_lost = 0;
    std::size_t passes_now = 0;               ///< made of those carried
    std::vector<std::string> lost_sections{}; ///< control sections whose road is gone, by name
    int generation = 1;
    bool changed = false; ///< false: the ways are the same
};

/// Where the passes of many cars meet: one GeoPackage file (docs/store.md). Each call that writes
/// is one transaction, all of it or nothing, on disk when it returns; only refresh() takes several,
/// so that others get their turn, and goes on where it was cut off.
///
/// Readers see the last commit and neither wait for a writer nor make it wait.
///
/// \throws InputError  from every call, if the file is missing, no store, kept locked by a
///                     program that does nothing with it, or cannot be written (the message names
///                     the file and the cause).
class RoadStore {
public:
    /// Makes a new store with the segments of a network, and its key (storage/privacy_key.hpp); a
    /// key that lies there already is taken. \throws InputError if the file exists; leaves nothing
    /// behind if it fails.
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
                          LockPatience patience = {},
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
    /// the store holds: kept_roads (storage/network_file.hpp) has it quicker.
    RoadNetwork roads() const;

    /// SHA-256 of these ways, in hex digits.
    std::string network_hash() const;

    /// Puts another network in the place of the store's own, as a new generation: passes and traces
    /// go to where the new one has their roads (mapping/carried_readings.hpp), and what they come
    /// to is fused. All of it is one transaction: readers see the old roads until it is done.
    /// Nothing is done if the ways are the same.
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

    bool knows_trip(const std::string& sha256) const;

    /// \returns false, and changes nothing, if the trip is already there, or was forgotten.
    bool add_trip(const TripRecord& trip,
                  std::span<const Pass> passes,
                  std::span<const StripTrace> traces = {});

    /// Many at once, which is quicker: all of them or, if one fails, none. \returns for each
    /// whether it is new.
    std::vector<bool> add_trips(std::span<const NewTrip> trips);

    /// Notes that an import has begun; `name` stands for what was asked, so that the same request
    /// finds its note again. \returns what an import of that name has done that began and did not
    /// end: it was killed, stopped, or still runs.
    std::optional<OpenImport> begin_import(const std::string& name, std::size_t trips_asked);

    /// Takes the note away: there is nothing left to do.
    void end_import(const std::string& name);

    /// Lays the passes of every strip with passes newer than their segments' states on each other
    /// and fuses them (mapping/alignment.hpp, mapping/fusion.hpp) by the rules of the store's
    /// generation. \returns how many segments had new passes.
    std::size_t refresh(const Progress& progress = {});

    /// Finds how the cars read from what they read of the same roads, and of what their errors are
    /// made; with `keep`, and if any car could be calibrated, begins a generation with these rules
    /// and puts all passes fused by them in place, in one transaction: readers see the numbers of
    /// before until all are made. Like all that follow here, it works them out beside the store
    /// and keeps others from writing only while it puts them in place; trips that come in
    /// meanwhile are fused by the new rules, and no car is calibrated from them.
    CalibrationReport calibrate(bool keep, const Progress& progress = {});

    /// Lays aside what a trip of the store says now that it was worked out anew; nobody sees it
    /// before take_staged(), and it goes with this object. \returns false if there is no such trip.
    bool stage_trip(const TripRecord& trip,
                    std::span<const Pass> passes,
                    std::span<const StripTrace> traces);

    /// Begins a generation with the trips that were laid aside in place of what they said before,
    /// and the others as they were, in one transaction. Cars that were calibrated are calibrated
    /// anew from the trips that they were calibrated from. \param how  for the audit.
    Reprocessed take_staged(std::string_view how, const Progress& progress = {});

    /// Takes trips and all that came of them out, in one transaction: passes, states, notes of
    /// numbers that they changed. What is left is what a store holds that never saw them; if cars
    /// were calibrated from them, they are calibrated anew from the others. Of each trip a mark is
    /// left by which it is known again (docs/store.md). Bytes are overwritten.
    ///
    /// \throws InputError  if there is no trip or vehicle of a name; nothing is changed.
    Forgotten forget(const ForgetRequest& request, const Progress& progress = {});

    /// Whether the trip was here and was forgotten; add_trip() leaves it out.
    bool has_forgotten(const std::string& sha256) const;

    /// Lets a forgotten trip in again.
    void take_back(const std::string& sha256);

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
    void glance(const SegmentFilter& filter,
                const std::function<void(const SegmentGlance&)>& visit) const;

    /// Passes over one segment, in the order of (trip hash, occurrence).
    std::vector<PassRecord> history(const SegmentKey& key) const;

    StoreInfo info() const;

    SeenSpan seen() const;

    /// Each direction counted; in the order of (highway, class from smooth to rough).
    std::vector<RoadClassLength> road_class_lengths() const;

    /// Days with a dated trip, in order.
    std::vector<DayUse> day_uses() const;

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
    LaySummary laid() const;

    /// SHA-256 over passes and states as text: the same content gives the same digest on any
    /// machine (docs/store.md says how the text is made).
    std::string digest() const;

private:
    struct Impl;
    explicit RoadStore(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

} // namespace macadam
