#pragma once

#include "render/report/report.hpp"

#include <string>
#include <vector>

namespace macadam::testing {

// Reports of invented towns, with placeholder bytes as pictures.

inline const ClassTable& fhwa = *class_table("fhwa");

inline RoadSummary summary_of(double network_m, std::vector<double> class_m) {
    RoadSummary roads;
    roads.network_m = network_m;
    for (const double length_m : class_m) {
        roads.covered_m += length_m;
        roads.classes.push_back({length_m, length_m, length_m});
    }
    roads.thrice_m = roads.covered_m / 2;
    roads.mean = {roads.covered_m, 2.5, 0.25, 2.1, 2.9};
    roads.p50 = 2.2;
    roads.p85 = 3.3;
    roads.p95 = 4.4;
    return roads;
}

inline ReportStretch stretch_named(const std::string& name) {
    WorstSection stretch{};
    stretch.name = name;
    stretch.highway = "residential";
    stretch.parts = {{123456, true, 100, 240}};
    stretch.line = {{45.75, 4.85}, {45.751, 4.85}};
    stretch.length_m = 140;
    stretch.mean = {140, 4.56, 0.5, 3.74, 5.38};
    stretch.worst_iri = 7.89;
    stretch.min_passes = 2;
    stretch.median_passes = 5;
    stretch.vehicles = 3;
    stretch.middle = {45.7505, 4.85};
    return {stretch, "N", {"2026-03-01", "2026-03-01"}, {{1, 2, 3}, {4, 5}, 480, 360}};
}

inline Report town() {
    Report report;
    report.title = "Spring survey";
    report.period = {"2026-03-01", "2026-04-02"};
    report.network_source = "town.osm.pbf";
    report.attribution = "© OpenStreetMap contributors (ODbL)";
    report.classes = &fhwa;
    report.colours = {0x2c7bb6, 0xfee090, 0xd7191c};
    report.summary.all = summary_of(20000, {1000, 2000, 5000});
    report.summary.kinds = {summary_of(20000, {1000, 2000, 5000})};
    report.summary.kinds[0].kind = "living_street";
    report.histogram = {1, {{1000, 0, 0}, {0, 2000, 500}, {0, 0, 4500}}};
    report.segments = 1000;
    report.segments_with_passes = 400;
    report.map = {{0, 0, 0}, {255, 255}, 1400, 1050};
    report.map_width_m = 4000;
    report.poor_above_mm_per_m = poor_above(fhwa);
    report.min_stretch_m = 100;
    report.stretches = 12;
    report.stretches_m = 2345;
    report.worst = {stretch_named("Rue de l'Épée"), stretch_named("")};
    report.vehicles = {{"1", "suv", "kf", 12, 2, 12345, 80, 60, 1000, 900}};
    report.quality.measured = {400, 8000};
    report.quality.both_tracks = {100, 2000};
    report.quality.inferred = {290, 5800};
    report.quality.lateral_alone = {10, 200};
    report.quality.start_up = {7, 140};
    report.lateral_passes = 37;
    report.row_reasons = {{"too_slow", 20}, {"repeated_fix", 70}};
    return report;
}

inline Report nothing_measured() {
    Report report;
    report.title = "Before the first trip";
    report.network_source = "town.osm.pbf";
    report.classes = &fhwa;
    report.colours = {0x2c7bb6, 0xfee090, 0xd7191c};
    report.summary.all = summary_of(20000, {0, 0, 0});
    report.histogram = {1, {{0, 0, 0}}};
    report.map = {{0}, {0}, 1400, 1050};
    return report;
}

inline Report changed_town() {
    auto report = town();
    ReportChange change{.since = "2026-03-15",
                        .change = {},
                        .colours = {0x2c7bb6, 0xfee090, 0xd7191c},
                        .dark_colours = {0x2c7bb6, 0xfee090, 0xd7191c},
                        .worse = {},
                        .better = {},
                        .map = {{1, 2}, {3}, 1400, 1050},
                        .map_width_m = 4000};
    change.change.segments.resize(200);
    change.change.called_alone = 23;
    change.change.all = {"", 500, 3000, 400, 200, 100, {3900, -0.25, 0.05}};
    change.change.kinds = {change.change.all};
    change.change.kinds[0].kind = "primary";
    const auto stretch = stretch_named("High Street").stretch;
    change.worse = {
        {{stretch, {140, 2, 0.1, 1.8, 2.2}, {140, 3.5, 0.1, 3.3, 3.7}, {140, 1.5, 0.2}, 1.17, 1.83},
         "SE",
         {{1, 2}, {3}, 480, 360}}};
    change.better = {
        {{stretch, {140, 4, 0.1, 3.8, 4.2}, {140, 2, 0.1, 1.8, 2.2}, {140, -2, 0.2}, -2.33, -1.67},
         "W",
         {{1, 2}, {3}, 480, 360}}};
    report.change = change;
    report.sections = {{.name = "A",
                        .from_m = 0,
                        .to_m = 500,
                        .excluded_m = 20,
                        .open_share = 0.9,
                        .measured = {}}};
    report.sections[0].measured.mean = {450, 2.5, 0.25, 2.1, 2.9};
    return report;
}

} // namespace macadam::testing
