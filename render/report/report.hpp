#pragma once

#include "mapping/data_quality.hpp"
#include "mapping/iri_class.hpp"
#include "mapping/measured_road.hpp"
#include "mapping/network_summary.hpp"
#include "mapping/worst_stretches.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace macadam {

/// One picture for light pages and paper, one for dark pages: PNG files of the same size.
struct ReportPicture {
    std::vector<std::uint8_t> light_png;
    std::vector<std::uint8_t> dark_png;
    int width_px = 0;
    int height_px = 0;
};

struct ReportStretch {
    RoadStretch stretch;
    std::string heading;   ///< "NE"
    std::string reference; ///< metres along its ways
    std::string seen;      ///< "2026-03-01 to 2026-04-02"
    ReportPicture map;
};

/// A section of the reader's own roads.
struct ReportSection {
    std::string name;
    double from_m; ///< stations; they fall where the road is driven against them
    double to_m;
    double excluded_m;
    double open_share; ///< measured length by what is not excluded
    MeasuredRoad measured;
};

/// What the trips of one car gave.
struct ReportVehicle {
    std::string name;  ///< pseudonym
    std::string model; ///< where it came from: "own file" or the name of a built-in one
    std::string method;
    std::size_t trips = 0;
    std::size_t undated_trips = 0;
    std::size_t passes = 0;
    double km = 0;
    double matched_km = 0;
    std::size_t rows_read = 0;
    std::size_t rows_used = 0;
};

/// All that a report says, as plain values. Texts are as they came: report_html escapes them.
struct Report {
    std::string title;
    std::string period;         ///< "" where no trip is dated
    std::string network_source; ///< what the roads were read from
    std::string attribution;    ///< whom to name for the map data, with the licence
    double segment_length_m = 20;
    const ClassTable* classes = nullptr;
    std::vector<std::uint32_t> colours; ///< one a class, 0xRRGGBB
    NetworkSummary summary;
    IriHistogram histogram;
    std::size_t segments = 0;
    std::size_t segments_with_passes = 0;
    ReportPicture map;
    double map_width_m = 0; ///< of the ground, from side to side of the map
    double poor_above_mm_per_m = 0;
    double least_stretch_m = 0;
    std::size_t stretches = 0;           ///< poor ones in all
    double stretches_m = 0;              ///< and their length
    std::vector<ReportStretch> worst;    ///< the worst of them, worst first
    std::vector<ReportSection> sections; ///< none: not asked for
    std::vector<ReportVehicle> vehicles; ///< in the order in which they are listed
    DataQuality quality;
    std::size_t lateral_passes = 0;                 ///< from lateral vibration alone
    std::map<std::string, std::size_t> row_reasons; ///< why rows of the logs entered no estimate
};

/// The report as one HTML page that needs nothing else: style, figures and pictures stand in it, no
/// script, no address of anything outside. It adapts to a phone's width, to paper (A4) and to dark
/// screens. The same values give the same bytes.
std::string report_html(const Report& report);

} // namespace macadam
