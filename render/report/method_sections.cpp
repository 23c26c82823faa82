#include "render/report/sections.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace macadam {

using namespace document;

namespace {

bool uses(const Report& report, const std::string& method) {
    return std::ranges::any_of(report.vehicles, [&method](const ReportVehicle& vehicle) {
        return vehicle.method == method;
    });
}

/// Rounds a value to the precision of an approximate size.
std::string rounded(const Report& report, double mm_per_m) {
    const double value = in_unit(mm_per_m, report.wording.unit);
    const double step = value < 20 ? 1 : value < 200 ? 10 : 50;
    return report.wording.whole(step * std::round(value / step));
}

} // namespace

DocumentSection reading_section(const Report& report) {
    const auto& say = report.wording;
    const bool metric = say.unit == IriUnit::mm_per_m;
    return {say("reading"),
            {Paragraph{say(metric ? "reading.iri.mm_per_m" : "reading.iri.in_per_mi",
                           {{"new", rounded(report, 1)},
                            {"worn", rounded(report, 3)},
                            {"worn_to", rounded(report, 5)},
                            {"broken", rounded(report, 10)}})},
             Paragraph{say("reading.intervals")}}};
}

DocumentSection method_section(const Report& report) {
    const auto& say = report.wording;
    std::string text = say("method.cars");
    for (const auto* const method : {"smoother", "kf"}) {
        text += uses(report, method) ? " " + say(std::string{"method."} + method) : "";
    }
    DocumentSection section{say("method"), {Paragraph{text + " " + say("method.fusion")}}};
    if (report.change) {
        section.blocks.emplace_back(Paragraph{
            say("method.change", {{"share", say.percent(report.change->change.config.rate, 1)}})});
    }
    return section;
}

DocumentSection limits_section(const Report& report) {
    const auto& say = report.wording;
    Bullets limits{{say("limits.estimates"), say("limits.tracks"), say("limits.segments")}};
    for (const auto* const method : {"smoother", "kf"}) {
        if (uses(report, method)) {
            limits.items.emplace_back(say(std::string{"limits."} + method));
        }
    }
    if (report.change) {
        limits.items.emplace_back(say("limits.change"));
    }
    return {say("limits"), {limits}};
}

DocumentSection source_section(const Report& report) {
    const auto& say = report.wording;
    auto text = say(
        "source.roads",
        {{"source", report.network_source.empty() ? say("source.traced") : report.network_source}});
    if (!report.attribution.empty()) {
        text += " " + report.attribution + ".";
    }
    return {say("source"), {Paragraph{text}}};
}

} // namespace macadam
