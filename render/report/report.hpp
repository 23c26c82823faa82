#pragma once

#include "estimator/events/road_event.hpp"
#include "mapping/analysis/change_since.hpp"
#include "mapping/analysis/correlated_mean.hpp"
#include "mapping/analysis/data_quality.hpp"
#include "mapping/analysis/network_summary.hpp"
#include "mapping/analysis/worst_sections.hpp"
#include "mapping/style/iri_class.hpp"
#include "mapping/style/map_style_values.hpp"
#include "render/report/document/document.hpp"
#include "render/report/words/localised_text.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// First and last day of a period, "2026-03-01"; "" if not dated.
struct ReportDays {
    std::string first;
    std::string last;
};

/// Roughness of an interval along a chainage, mm/m.
struct StripPiece {
    double from_m, to_m;
    double iri;
    double low, high; ///< 90 % interval
    std::size_t iri_class;
};

/// One direction of a strip chart.
struct StripRow {
    std::string title;
    std::vector<StripPiece> pieces; ///< by chainage
};

/// Point of a chainage, such as a junction.
struct StripMark {
    double at_m;
    std::string name;
};

/// Interval of a chainage with a name, such as a control or reference section.
struct StripSpan {
    double from_m, to_m;
    std::string name;
};

/// Photo of a road, reduced.
struct ReportPhoto {
    std::vector<std::uint8_t> jpeg; ///< bytes of a file
    int width_px, height_px;
    std::string day;   ///< on which it was taken; "" = unknown
    double distance_m; ///< from the road
    double at_m = 0;   ///< along the line at which it is shown, as in Strip
};

/// Content of a strip chart.
struct Strip {
    double from_m, to_m;
    std::vector<StripRow> rows;
    std::vector<StripMark> marks{}; ///< by chainage
    std::vector<StripSpan> spans{};
    std::vector<GeoPoint> line{};      ///< of the road, without its gaps
    std::vector<ReportPhoto> photos{}; ///< by chainage
};

struct ReportStretch {
    WorstSection stretch;
    std::string heading; ///< "NE"
    ReportDays seen;
    ReportPicture map;
    std::vector<StripPiece> strip{}; ///< by metres from the section's beginning, as driven
    std::vector<ReportPhoto> photos{};
};

/// Section of the user's own list.
struct ReportSection {
    std::string name;
    double from_m; ///< stations; decreasing where the road is driven against them
    double to_m;
    double excluded_m;
    double open_share; ///< measured length over length without exclusions
    CorrelatedMean measured;
};

/// Summary of the trips of one car.
struct ReportVehicle {
    std::string name;  ///< number of the car in the database; "" = trips without a car
    std::string model; ///< built-in model; "" = the user's own
    std::string method;
    std::size_t trips = 0;
    std::size_t undated_trips = 0;
    std::size_t passes = 0;
    double km = 0;
    double matched_km = 0;
    std::size_t rows_read = 0;
    std::size_t rows_used = 0;
};

/// Road section that has become rougher or smoother.
struct ReportChangedStretch {
    ChangedStretch stretch;
    std::string heading;
    ReportPicture map;
};

/// Changes since a day.
struct ReportChange {
    std::string since; ///< day, "2026-03-01"
    ChangeSince change;
    std::array<std::uint32_t, 3> colours;      ///< of the map, in the order of Verdict
    std::array<std::uint32_t, 3> dark_colours; ///< likewise, on dark pages
    std::vector<ReportChangedStretch> worse;   ///< largest change first
    std::vector<ReportChangedStretch> better;
    ReportPicture map;
    double map_width_m = 0;
};

/// Roads drawn in grey because they have fewer passes than required.
struct ReportFewPasses {
    int min_passes;
    std::uint32_t rgb;
    std::uint32_t dark_rgb; ///< on dark pages
};

/// Totals of a crowd's publication. Trips and cars are lower bounds.
struct ReportPublication {
    std::string month; ///< "2026-11"; "" = not yet published
    std::size_t trips = 0;
    std::size_t cars = 0;
    std::size_t passes = 0;
    std::size_t left_out = 0; ///< segments with too few cars, rounded to tens
    double left_out_m = 0;    ///< length of these segments
};

/// Pothole or other event of the road.
struct ReportEvent {
    EventKind kind;
    double size_mm, sd_mm;
    std::string name;    ///< of the road; "" = none
    std::string highway; ///< class of the road; "" = none
    std::int64_t way_id;
    double at_m; ///< along the way, from its first node
    GeoPoint at;
    std::int32_t passes, passes_over; ///< that report it, and that were searched there
    std::string last_seen;            ///< day; "" = undated
};

/// Content of a report, as plain values. Texts are unprocessed.
struct Report {
    Localisation wording{};
    std::string title;
    ReportDays period;
    std::string selection{};    ///< of segments and passes, as options; "" = all
    std::string network_source; ///< source of the roads; "" = traced from the trips
    std::string attribution;    ///< copyright notice of the map data, with the licence
    double segment_length_m = 20;
    const ClassTable* classes = nullptr;
    std::vector<std::uint32_t> colours;        ///< one per class, 0xRRGGBB
    LegendWords words{};                       ///< of classes; defaults are translated
    std::optional<ReportFewPasses> few_passes; ///< `std::nullopt`: not used
    NetworkSummary summary;
    IriHistogram histogram;
    std::size_t segments = 0;
    std::size_t segments_with_passes = 0;
    ReportPicture map;
    double map_width_m = 0; ///< ground distance from side to side of the map
    double poor_above_mm_per_m = 0;
    double min_stretch_m = 0;
    std::size_t stretches = 0;           ///< number of poor sections
    double stretches_m = 0;              ///< their total length
    std::vector<ReportStretch> worst;    ///< of them, the greatest need of repair first
    std::vector<ReportEvent> events{};   ///< the largest first
    std::size_t events_found = 0;        ///< including those not listed
    std::optional<ReportChange> change;  ///< `std::nullopt`: not requested
    std::vector<ReportSection> sections; ///< empty: not requested
    std::vector<Strip> strips{}; ///< of one road, in order of chainage; empty: not requested
    std::vector<ReportVehicle> vehicles; ///< in listing order
    DataQuality quality;
    std::size_t lateral_passes = 0;                 ///< from lateral acceleration alone
    std::map<std::string, std::size_t> row_reasons; ///< reasons for rejected rows of the logs
    std::optional<ReportPublication> publication;   ///< of a crowd; excludes single cars
    bool is_own = true;                             ///< of the operator's own cars: not anonymised
};

/// Builds the document in the report's language and unit, for any kind of page.
Document report_document(const Report& report);

/// Returns the document as one self-contained HTML page: style, figures and pictures are embedded,
/// without scripts or external addresses. It adapts to a phone's width, to paper (A4) and to dark
/// screens. The same document gives the same bytes.
std::string html_of(const Document& document);

std::string report_html(const Report& report);

} // namespace macadam
