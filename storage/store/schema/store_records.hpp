#pragma once

#include "estimator/common/geo.hpp"
#include "mapping/alignment/alignment.hpp"
#include "mapping/fusion/segment_record.hpp"
#include "mapping/network/segment.hpp"
#include "mapping/passes/chunk_trace.hpp"
#include "mapping/passes/pass.hpp"
#include "mapping/transfer/network_change_summary.hpp"
#include "storage/store/privacy/privacy_profile.hpp"
#include "storage/store/privacy/publication.hpp"
#include "storage/store/schema/usage_records.hpp"

#include <cstdint>
#include <map>
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
    std::span<const RoughnessTrace> traces;
    bool readmit = false; ///< comes in also if it was forgotten
};

/// One pass with where it came from: a line of a segment's history.
struct HistoricPass {
    Pass pass;
    std::string trip_sha256;
    std::string vehicle; ///< pseudonym; "" of a reference
    std::optional<std::int64_t> utc_ms;
    std::optional<std::string> reference{}; ///< name of the survey, if it is one

    /// How far behind its own place the road lay that the trip read there, by what others read; as
    /// the fusion takes it. Nothing: the pass has no trace.
    std::optional<double> lag_m{};
    LagStatus finding = LagStatus::alone; ///< why it is so, or 0
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
    AlignmentSummary laid;   ///< of all chunks that were fused; the median of the chunks' medians
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

} // namespace macadam
