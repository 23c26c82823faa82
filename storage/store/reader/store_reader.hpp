#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/fusion/segment_record.hpp"
#include "mapping/network/road_network.hpp"
#include "mapping/surveys/control_section.hpp"
#include "storage/sqlite/lock_wait_policy.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/records/maintenance_records.hpp"
#include "storage/store/records/publication.hpp"
#include "storage/store/records/segment_filter.hpp"
#include "storage/store/records/store_moment.hpp"
#include "storage/store/records/store_records.hpp"
#include "storage/store/records/usage_records.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

struct StoreConnection;

/// Reads a road database (docs/reference/database.md). Copies share one connection. Each call sees
/// the last commit; readers and the writer do not wait for each other.
///
/// \throws InputError  from every call, if the file is missing or not a road database (the message
///                     names the file and the cause).
class StoreReader {
public:
    /// Opens a database for reading.
    ///
    /// \param wait_policy  rules for waiting while another process writes, from opening on; its
    ///                     stop token ends the wait and also interrupts reading. By default, it
    ///                     waits for as long as the other process makes progress.
    /// \param audience  audience for which the database is read.
    static StoreReader open(const std::filesystem::path& file,
                            LockWaitPolicy wait_policy = {},
                            Audience audience = Audience::anyone);

    explicit StoreReader(std::shared_ptr<StoreConnection> store) : store_{std::move(store)} {}

    const StoreSettings& settings() const;

    const std::filesystem::path& file() const;

    /// Key of the database, if it lies beside it and is readable by this user; else null. open()
    /// throws InputError if the key file belongs to another database.
    const PrivacyKey* key() const;

    /// Path of the key, whether it exists or not.
    const std::filesystem::path& key_file() const;

    /// Tests whether there is a key. Its holder is the operator, who sees unpublished data of a
    /// crowd database.
    bool is_operator() const { return key() != nullptr; }

    /// Tests whether all data read here comes from the latest publication of a crowd database.
    bool shows_published_alone() const;

    /// Latest publication; `std::nullopt` if nothing was published yet.
    std::optional<Publication> latest_publication() const;

    /// Checks at the end of reading that the data is current.
    ///
    /// \throws InputError  if the file was removed or replaced since it was opened.
    void expect_in_place() const;

    /// Has all calls, also of copies of this reader, see one commit for as long as the result
    /// lives.
    std::shared_ptr<const void> hold() const;

    /// Mark of what is seen now.
    StoreMoment moment() const;

    /// Finds segments with new values since a moment of the same file, and others near them; the
    /// roads are then the same. Ranges do not overlap.
    ///
    /// \returns `std::nullopt` if anything may have changed, as by maintenance or a publication.
    std::optional<std::vector<SegmentRange>> changed_since(const StoreMoment& before) const;

    /// Network of this database, from which its segments are cut, built from the stored ways.
    /// load_or_build_network (storage/networks/network_file.hpp) is faster.
    RoadNetwork roads() const;

    /// SHA-256 of the ways, in hex digits.
    std::string network_hash() const;

    /// OSM classes of the roads in alphabetical order, "" if some have none; at most 100.
    std::vector<std::string> highways() const;

    bool contains_trip(const std::string& sha256) const;

    /// Tests whether a trip in the database was imported as one of this car.
    bool is_trip_of(const std::string& sha256, const std::string& vehicle_id) const;

    /// Settings with which a trip of a car was imported; `std::nullopt` if there is no such trip.
    std::optional<TripSettings> settings_of_trip(const std::string& sha256) const;

    /// Tests whether the trip was forgotten; TripImporter::add_trips() skips such trips.
    bool has_forgotten(const std::string& sha256) const;

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

    /// Times and causes of the changes of a segment's value, oldest first.
    std::vector<NumberChange> changes(const SegmentKey& key) const;

    /// Log of all operations that changed values, oldest first.
    std::vector<AuditEntry> audit() const;

    /// Segments with a time from which passes count, in the order of keys.
    std::vector<ValidSince> valid_since() const;

    /// Control sections in the order of their names.
    std::vector<ControlSection> control_sections() const;

    /// Reference surveys, in the order of (name, hash).
    std::vector<SurveyUse> surveys() const;

    /// Readings of reference surveys, in the order of (segment, survey, occurrence), without the
    /// polylines of the segments.
    std::vector<ReferenceReading> reference_readings() const;

    StoreInfo info() const;

    /// Use of the database by its cars. Takes time in proportion to the passes.
    StoreUsage usage() const;

    /// Part of info(), faster: times of the first and the last dated pass.
    ObservedPeriod seen() const;

    /// Part of info(), faster: number of segments whose new passes are not yet fused.
    std::size_t waiting() const;

    /// Part of info(), faster: box around all segments.
    GeoBox map_box() const;

    /// Part of info(), faster: summary of the alignment of passes.
    AlignmentSummary alignment() const;

    /// Mean speed of the cars' passes over each segment, km/h; segments without one are missing.
    std::map<SegmentKey, double> mean_speeds_kmh() const;

    /// Estimates what StoreMaintenance::calibrate() would apply, without writing.
    CalibrationReport estimate_calibration(const Progress& progress = {}) const;

    /// SHA-256 over passes and states as text: equal content gives an equal digest on any machine
    /// (docs/reference/database.md describes the text).
    std::string digest() const;

private:
    std::shared_ptr<StoreConnection> store_;
};

} // namespace macadam
