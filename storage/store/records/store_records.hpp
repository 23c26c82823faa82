#pragma once

#include "estimator/common/geo.hpp"
#include "mapping/alignment/alignment.hpp"
#include "mapping/events/event_fusion.hpp"
#include "mapping/fusion/segment_record.hpp"
#include "mapping/network/segment.hpp"
#include "mapping/passes/chunk_trace.hpp"
#include "mapping/passes/pass.hpp"
#include "mapping/transfer/network_change_summary.hpp"
#include "storage/store/records/privacy_profile.hpp"
#include "storage/store/records/publication.hpp"
#include "storage/store/records/usage_records.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

inline constexpr std::int64_t max_kept_logs_days = 3650;

/// Rule by which a server keeps logs of a crowd, encrypted (storage/uploads/kept_logs.hpp).
struct LogKeeping {
    std::int64_t days = 0;    ///< after it came; 0: a log is erased once it was imported
    std::string public_key{}; ///< 64 hex digits
};

/// Settings with which a database is created.
struct StoreSettings {
    double segment_length_m = 20;
    std::string class_table = "fhwa";
    std::string network_source; ///< file name of the map, or "traced from the trips"
    std::string attribution;    ///< copyright notice for pictures of these roads
    PrivacyProfile privacy = PrivacyProfile::own;
    std::int64_t max_trips_per_car_month = 0; ///< of a car that are fused over a segment; 0: all
    LogKeeping kept_logs{};
};

/// Replaces the name of the map for roads from `init --trace`.
inline constexpr std::string_view traced_network_source = "traced from the trips";

/// Replaces the model name of a user's own vehicle file, whose name could identify the car.
inline constexpr std::string_view own_file_model = "own file";

/// Marks a trip as a reference survey with better instruments.
struct ReferenceNote {
    std::int32_t relative_sd_ppm; ///< stated accuracy, relative to the value
    std::int32_t row_mm;          ///< median length of its rows
};

/// Stored attributes of a trip; positions and the log are not stored.
struct TripRecord {
    std::string sha256; ///< unique
    std::string trip_id;
    std::string
        vehicle_id; ///< stored only as a pseudonym, also within the two names; "" = not stated
    std::string file_name;
    std::optional<std::int64_t> t0_utc_ms; ///< `std::nullopt`: undated
    std::string vehicle_model;             ///< name of the built-in Vehicle, or own_file_model
    std::string method;
    std::int64_t distance_mm = 0;
    std::int64_t matched_mm = 0;
    std::size_t rows_read = 0;
    std::size_t rows_used = 0;
    std::map<std::string, std::size_t> row_reasons{}; ///< reasons for which rows were not used
    std::int64_t trimmed_mm = 0; ///< left out at ends and long stops by the recorder, as it states

    /// Set for a survey: then trip_id is its name, t0_utc_ms its day, and vehicle_id is empty.
    std::optional<ReferenceNote> reference{};
};

/// Settings of the estimation of a stored trip, as in TripRecord.
struct TripSettings {
    std::string method;
    std::string vehicle_model;
};

/// Trip with its passes and traces.
struct NewTrip {
    const TripRecord* trip;
    std::span<const Pass> passes;
    std::span<const RoughnessTrace> traces;
    bool readmit = false; ///< import it even if it was forgotten

    /// Events on the passes; `std::nullopt`: the trip was not searched for events.
    std::optional<std::span<const PassEvent>> events{};
};

/// Event of the road with its position and road.
struct EventRecord {
    FusedEvent event;
    GeoPoint at;         ///< on the polyline of the road
    std::string name;    ///< of the road, "" if the map has none
    std::string highway; ///< OSM's class, "" if there is none
};

/// Pass with its origin, as an entry of a segment's history.
struct HistoricPass {
    Pass pass;
    std::string trip_sha256;
    std::string vehicle; ///< pseudonym; "" for a reference
    std::optional<std::int64_t> utc_ms;
    std::optional<std::string> reference{}; ///< name of the survey

    /// Lag of the trip's positions relative to other trips, as used by the fusion. `std::nullopt`:
    /// the pass has no trace.
    std::optional<double> lag_m{};
    LagStatus finding = LagStatus::alone; ///< reason for the lag, or for the lack of one
};

/// Reading of a segment by a survey.
struct ReferenceReading {
    Segment segment;
    std::string highway;
    Pass pass;
    std::size_t survey; ///< index in StoreReader::surveys()
};

/// Import that started but did not finish.
struct OpenImport {
    std::size_t trips_asked;
    std::size_t trips_added; ///< to the database since it started, by anyone
};

struct StoreInfo {
    StoreSettings settings;
    std::size_t trips = 0; ///< of cars, as are all counts of trips and passes
    std::size_t undated_trips = 0;
    std::size_t passes = 0;
    std::size_t lateral_passes = 0;    ///< from lateral vibration only
    std::vector<std::string> vehicles; ///< pseudonyms, in the order of StoreUsage::cars
    std::size_t segments = 0;
    std::size_t segments_with_passes = 0;     ///< of cars or references
    double km = 0;                            ///< of segments with passes
    std::optional<Publication> publication{}; ///< latest publication of a crowd database
    /// All values are from it; counts of trips and passes are lower bounds.
    bool published_alone = false;
    double network_km = 0; ///< all segments, each direction counted
    std::vector<ClassLength> classes;
    std::optional<std::int64_t> first_seen_ms;
    std::optional<std::int64_t> last_seen_ms;
    std::size_t waiting = 0;    ///< segments whose new passes are not yet fused
    AlignmentSummary alignment; ///< of all fused chunks; the median is that of the chunks' medians
    int generation = 1;
    GeoBox box; ///< of segments with passes; of all segments if there are none
};

/// Origin of a network.
struct NetworkSource {
    std::string name;        ///< as StoreSettings::network_source
    std::string attribution; ///< as StoreSettings::attribution
};

/// Result of a network update.
struct NetworkUpdate {
    ChangeSummary roads;
    std::size_t passes_kept = 0;    ///< on ways that were kept
    std::size_t passes_carried = 0; ///< former passes that are at least partly transferred
    std::size_t passes_lost = 0;
    std::size_t passes_now = 0;               ///< passes that they became
    std::vector<std::string> lost_sections{}; ///< control sections whose road is gone
    int generation = 1;
    bool changed = false; ///< false: the ways are equal
};

} // namespace macadam
