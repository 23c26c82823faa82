#pragma once

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

/// First and last day of something, "2026-03-01"; "" where it is not dated.
struct ReportDays {
    std::string first;
    std::string last;
};

struct ReportStretch {
    WorstSection stretch;
    std::string heading; ///< "NE"
    ReportDays seen;
    ReportPicture map;
};

/// A section of the reader's own roads.
struct ReportSection {
    std::string name;
    double from_m; ///< stations; they fall where the road is driven against them
    double to_m;
    double excluded_m;
    double open_share; ///< measured length by what is not excluded
    CorrelatedMean measured;
};

/// What the trips of one car gave.
struct ReportVehicle {
    std::string name;  ///< number of the car in the store; "" = trips that name none
    std::string model; ///< name of a built-in one; "" = the user's own
    std::string method;
    std::size_t trips = 0;
    std::size_t undated_trips = 0;
    std::size_t passes = 0;
    double km = 0;
    double matched_km = 0;
    std::size_t rows_read = 0;
    std::size_t rows_used = 0;
};

/// A stretch that has become rougher or smoother.
struct ReportChangedStretch {
    ChangedStretch stretch;
    std::string heading;
    ReportPicture map;
};

/// What has changed since a day.
struct ReportChange {
    std::string since; ///< day, "2026-03-01"
    ChangeSince change;
    std::array<std::uint32_t, 3> colours;    ///< of the map, in the order of Verdict
    std::vector<ReportChangedStretch> worse; ///< the most first
    std::vector<ReportChangedStretch> better;
    ReportPicture map;
    double map_width_m = 0;
};

/// Roads that the maps draw in grey, because fewer passes of cars are known than were asked for.
struct ReportFewPasses {
    int min_passes;
    std::uint32_t rgb;
    std::uint32_t dark_rgb; ///< on dark pages
};

/// What a crowd's publication tells in all. Trips and cars: at least so many.
struct ReportPublication {
    std::string month; ///< "2026-11"; "" = nothing was published yet
    std::size_t trips = 0;
    std::size_t cars = 0;
    std::size_t passes = 0;
    std::size_t left_out = 0; ///< segments that too few cars drove, up to tens
    double left_out_m = 0;    ///< of them
};

/// All that a report says, as plain values. Texts are as they came.
struct Report {
    Localisation wording{};
    std::string title;
    ReportDays period;
    std::string network_source; ///< what the roads were read from; "" = traced from the trips
    std::string attribution;    ///< whom to name for the map data, with the licence
    double segment_length_m = 20;
    const ClassTable* classes = nullptr;
    std::vector<std::uint32_t> colours; ///< one a class, 0xRRGGBB
    LegendWords words{};                ///< of classes; what is as by default is in the language
    std::optional<ReportFewPasses> few_passes; ///< nothing: no road is drawn so
    NetworkSummary summary;
    IriHistogram histogram;
    std::size_t segments = 0;
    std::size_t segments_with_passes = 0;
    ReportPicture map;
    double map_width_m = 0; ///< of the ground, from side to side of the map
    double poor_above_mm_per_m = 0;
    double min_stretch_m = 0;
    std::size_t stretches = 0;           ///< poor ones in all
    double stretches_m = 0;              ///< and their length
    std::vector<ReportStretch> worst;    ///< the worst of them, worst first
    std::optional<ReportChange> change;  ///< nothing: not asked for
    std::vector<ReportSection> sections; ///< none: not asked for
    std::vector<ReportVehicle> vehicles; ///< in the order in which they are listed
    DataQuality quality;
    std::size_t lateral_passes = 0;                 ///< from lateral vibration alone
    std::map<std::string, std::size_t> row_reasons; ///< why rows of the logs entered no estimate
    std::optional<ReportPublication> publication;   ///< of a crowd: it tells of no single car
    bool is_own = true; ///< of the operator's own cars: nothing is anonymised
};

/// What the report says, in its language and unit, for any kind of page.
Document report_document(const Report& report);

/// The document as one HTML page that needs nothing else: style, figures and pictures stand in it,
/// no script, no address of anything outside. It adapts to a phone's width, to paper (A4) and to
/// dark screens. The same document gives the same bytes.
std::string html_of(const Document& document);

std::string report_html(const Report& report);

} // namespace macadam
