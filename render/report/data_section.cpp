#include "mapping/pass.hpp"
#include "render/report/html.hpp"
#include "render/report/numbers.hpp"
#include "render/report/parts.hpp"
#include "render/report/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace macadam {
namespace {

constexpr std::size_t most_vehicles = 30; // a page of them; the rest stands in one row

std::vector<std::string> row_of(const ReportVehicle& vehicle, const std::string& name) {
    return {name,
            escaped(vehicle.model),
            escaped(vehicle.method),
            count_text(vehicle.trips),
            count_text(vehicle.undated_trips),
            fmt::format("{:.1f}", vehicle.km),
            percent_text(vehicle.matched_km, vehicle.km),
            percent_text(static_cast<double>(vehicle.rows_used),
                         static_cast<double>(vehicle.rows_read)),
            count_text(vehicle.passes)};
}

HtmlTable vehicle_table(const std::vector<ReportVehicle>& vehicles) {
    HtmlTable table{"Cars (pseudonyms) and the quality of their data",
                    {{"Car"},
                     {"Model used"},
                     {"Method"},
                     {"Trips", true},
                     {"Undated", true},
                     {"km", true},
                     {"On the map", true},
                     {"Rows used", true},
                     {"Passes", true}},
                    {}};
    table.stacks = true;
    const auto shown = std::min(vehicles.size(), most_vehicles);
    for (std::size_t i = 0; i < shown; ++i) {
        table.rows.push_back(row_of(vehicles[i], escaped(vehicles[i].name)));
    }
    if (shown < vehicles.size()) {
        const auto first = vehicles.begin() + static_cast<std::ptrdiff_t>(shown);
        table.rows.push_back(row_of(total_of({first, vehicles.end()}),
                                    fmt::format("{} more rows", vehicles.size() - shown)));
    }
    if (vehicles.size() > 1) {
        table.rows.push_back(row_of(total_of(vehicles), "All"));
        table.sum = true;
    }
    return table;
}

HtmlTable quality_table(const DataQuality& quality) {
    HtmlTable table{"What the values of segments rest on",
                    {{"Basis"}, {"Segments", true}, {"km", true}, {"Share of km", true}},
                    {}};
    const auto add = [&](const char* name, const SegmentCount& count) {
        table.rows.push_back({name,
                              count_text(count.segments),
                              km_text(count.length_m, quality.measured.length_m),
                              percent_text(count.length_m, quality.measured.length_m)});
    };
    add("Both wheel tracks: MRI observed", quality.both_tracks);
    add("Middle of the car: MRI inferred", quality.inferred);
    add("Lateral vibration alone: MRI inferred", quality.lateral_alone);
    add("A part driven too slowly to count", quality.too_slow);
    add("A part within the start-up of the method", quality.start_up);
    add("A part without data", quality.gap);
    add("All", quality.measured);
    table.sum = true;
    return table;
}

std::string quality_html(const Report& report) {
    if (report.quality.measured.segments == 0) {
        return {};
    }
    auto html = html_of(quality_table(report.quality)) +
                fmt::format("<p class=\"small quiet\">MRI is the mean of both wheel tracks. Where "
                            "only the middle of the car was felt, its HRI was measured and MRI "
                            "inferred: MRI = HRI / {:.2f}; real roads have {:.2f} to {:.2f}, which "
                            "the interval counts. Such values are <em>indicative</em>. The three "
                            "rows on parts hold for what every pass over a segment has.</p>\n",
                            hri_over_mri,
                            hri_over_mri - sd_hri_over_mri,
                            hri_over_mri + sd_hri_over_mri);
    if (report.lateral_passes > 0) {
        html += fmt::format("<p>{} from lateral vibration alone, because the log had no vertical "
                            "acceleration: far less accurate.</p>\n",
                            count_text(report.lateral_passes, "pass is", "passes are"));
    }
    return html;
}

/// The reasons, the most frequent first, and the rows of which none is known.
std::vector<std::pair<std::string, std::size_t>> reasons_of(const Report& report,
                                                            std::size_t rejected) {
    std::vector<std::pair<std::string, std::size_t>> reasons;
    std::size_t known = 0;
    for (const auto& [reason, rows] : report.row_reasons) {
        reasons.emplace_back(sentence_case(reason), rows);
        known += rows;
    }
    std::ranges::stable_sort(
        reasons, std::ranges::greater{}, &std::pair<std::string, std::size_t>::second);
    if (known < rejected) {
        reasons.emplace_back("Not kept by an earlier version", rejected - known);
    }
    return reasons;
}

std::string reasons_html(const Report& report) {
    const auto total = total_of(report.vehicles);
    const auto rejected = total.rows_read - std::min(total.rows_read, total.rows_used);
    if (rejected == 0) {
        return {};
    }
    HtmlTable table{"Rows of the logs that entered no estimate, by reason",
                    {{"Reason"}, {"Rows", true}, {"Share of all rows", true}},
                    {}};
    const auto add = [&](const std::string& name, std::size_t rows) {
        table.rows.push_back(
            {name,
             count_text(rows),
             percent_text(static_cast<double>(rows), static_cast<double>(total.rows_read))});
    };
    for (const auto& [reason, rows] : reasons_of(report, rejected)) {
        add(reason, rows);
    }
    add("All", rejected);
    table.sum = true;
    return html_of(table);
}

} // namespace

std::string data_section(const Report& report) {
    auto html = std::string{"<section>\n<h2>Cars and data</h2>\n"};
    if (report.vehicles.empty()) {
        return html + "<p>No trip was imported yet.</p>\n</section>\n";
    }
    return html + html_of(vehicle_table(report.vehicles)) +
           "<p class=\"small quiet\">Cars stand under pseudonyms. Model: from the user's own file, "
           "or a built-in one. On the map: the share of the distance that was matched to a road. "
           "Rows used: the share of the sensors' rows that entered an estimate.</p>\n" +
           quality_html(report) + reasons_html(report) + "</section>\n";
}

} // namespace macadam
