#include "mapping/passes/pass.hpp"
#include "render/report/common_parts.hpp"
#include "render/report/sections.hpp"

#include <algorithm>
#include <utility>

namespace macadam {

using namespace document;

namespace {

constexpr std::size_t max_vehicles = 30; // one page; the remaining ones are summed in one row

/// \param model  description of the vehicle model
std::vector<Cell> row_of(const Localisation& say,
                         const ReportVehicle& vehicle,
                         const std::string& name,
                         const std::string& model) {
    return {
        name,
        model,
        vehicle.method,
        say.count(vehicle.trips),
        say.count(vehicle.undated_trips),
        say.number(say.long_length(1000 * vehicle.km), 1),
        say.percent(vehicle.matched_km, vehicle.km),
        say.percent(static_cast<double>(vehicle.rows_used), static_cast<double>(vehicle.rows_read)),
        say.count(vehicle.passes)};
}

std::string model_text(const Localisation& say, const ReportVehicle& vehicle) {
    return vehicle.model.empty() ? say("model.own")
                                 : say("model.built_in", {{"model", vehicle.model}});
}

Table vehicle_table(const Report& report) {
    const auto& say = report.wording;
    const auto& vehicles = report.vehicles;
    Table table{say("cars.caption"),
                {{say("column.car")},
                 {say("column.model")},
                 {say("column.method")},
                 {say("column.trips"), true},
                 {say("column.undated"), true},
                 {say.long_unit(), true},
                 {say("column.matched"), true},
                 {say("column.rows_used"), true},
                 {say("column.passes"), true}},
                {}};
    table.stacks = true;
    const auto shown = std::min(vehicles.size(), max_vehicles);
    for (std::size_t i = 0; i < shown; ++i) {
        const auto& name = vehicles[i].name;
        table.rows.push_back(row_of(say,
                                    vehicles[i],
                                    name.empty() ? say("car.unnamed") : name,
                                    model_text(say, vehicles[i])));
    }
    if (shown < vehicles.size()) {
        const auto first = vehicles.begin() + static_cast<std::ptrdiff_t>(shown);
        table.rows.push_back(row_of(say,
                                    total_of({first, vehicles.end()}),
                                    say.counted("cars.more", vehicles.size() - shown),
                                    ""));
    }
    if (vehicles.size() > 1) {
        table.rows.push_back(row_of(say, total_of(vehicles), say("all"), ""));
        table.sum = true;
    }
    return table;
}

Table quality_table(const Report& report) {
    const auto& say = report.wording;
    const auto& quality = report.quality;
    Table table{say("quality.caption"),
                {{say("column.basis")},
                 {say("column.segments"), true},
                 {say.long_unit(), true},
                 {say("column.share_of_km"), true}},
                {}};
    const auto add = [&](const char* name, const SegmentCount& count) {
        table.rows.push_back({say(name),
                              say.count(count.segments),
                              say.road_length(count.length_m, quality.measured.length_m),
                              say.percent(count.length_m, quality.measured.length_m)});
    };
    add("quality.both_tracks", quality.both_tracks);
    add("quality.inferred", quality.inferred);
    add("quality.lateral", quality.lateral_alone);
    add("quality.too_slow", quality.too_slow);
    add("quality.start_up", quality.start_up);
    add("quality.gap", quality.gap);
    add("all", quality.measured);
    table.sum = true;
    return table;
}

void add_quality(DocumentSection& section, const Report& report) {
    const auto& say = report.wording;
    if (report.quality.measured.segments == 0) {
        return;
    }
    section.blocks.emplace_back(quality_table(report));
    section.blocks.emplace_back(
        Paragraph{say("quality.remark",
                      {{"ratio", say.number(hri_over_mri, 2)},
                       {"low", say.number(hri_over_mri - sd_hri_over_mri, 2)},
                       {"high", say.number(hri_over_mri + sd_hri_over_mri, 2)}}),
                  true});
    if (report.lateral_passes > 0) {
        section.blocks.emplace_back(
            Paragraph{say.counted("quality.lateral_passes", report.lateral_passes)});
    }
}

/// Returns the reasons, the most frequent first, and the count of rows without a known reason.
std::vector<std::pair<std::string, std::size_t>> reasons_of(const Report& report,
                                                            std::size_t rejected) {
    std::vector<std::pair<std::string, std::size_t>> reasons;
    std::size_t known = 0;
    for (const auto& [reason, rows] : report.row_reasons) {
        reasons.emplace_back(report.wording.or_else("reason." + reason, sentence_case(reason)),
                             rows);
        known += rows;
    }
    std::ranges::stable_sort(
        reasons, std::ranges::greater{}, &std::pair<std::string, std::size_t>::second);
    if (known < rejected) {
        reasons.emplace_back(report.wording("reasons.not_kept"), rejected - known);
    }
    return reasons;
}

void add_reasons(DocumentSection& section, const Report& report) {
    const auto& say = report.wording;
    const auto total = total_of(report.vehicles);
    const auto rejected = total.rows_read - std::min(total.rows_read, total.rows_used);
    if (rejected == 0) {
        return;
    }
    Table table{
        say("reasons.caption"),
        {{say("column.reason")}, {say("column.rows"), true}, {say("column.share_of_rows"), true}},
        {}};
    const auto add = [&](const std::string& name, std::size_t rows) {
        table.rows.push_back(
            {name,
             say.count(rows),
             say.percent(static_cast<double>(rows), static_cast<double>(total.rows_read))});
    };
    for (const auto& [reason, rows] : reasons_of(report, rejected)) {
        add(reason, rows);
    }
    add(say("all"), rejected);
    table.sum = true;
    section.blocks.emplace_back(std::move(table));
}

} // namespace

DocumentSection data_section(const Report& report) {
    const auto& say = report.wording;
    DocumentSection section{say("data"), {}};
    if (report.is_own) {
        section.blocks.emplace_back(Paragraph{say("data.own")});
    }
    if (const auto& crowd = report.publication) {
        section.blocks.emplace_back(
            Paragraph{crowd->month.empty()
                          ? say("data.crowd.nothing")
                          : say("data.crowd",
                                {{"month", crowd->month},
                                 {"segments", say.count(crowd->left_out)},
                                 {"km", say.number(say.long_length(crowd->left_out_m), 1)}})});
        add_quality(section, report);
        return section;
    }
    if (report.vehicles.empty()) {
        section.blocks.emplace_back(Paragraph{say("data.nothing")});
        return section;
    }
    section.blocks.emplace_back(vehicle_table(report));
    section.blocks.emplace_back(Paragraph{say("data.remark"), true});
    add_quality(section, report);
    add_reasons(section, report);
    return section;
}

} // namespace macadam
