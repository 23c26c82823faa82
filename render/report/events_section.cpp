#include "render/report/common_parts.hpp"
#include "render/report/sections.hpp"
#include "render/scene/isolated_text.hpp"

#include <fmt/format.h>

namespace macadam {

using namespace document;

namespace {

std::string position_text(const Report& report, const ReportEvent& event) {
    const bool of_osm = report.attribution.find("OpenStreetMap") != std::string::npos;
    return report.wording(of_osm ? "event.place_osm" : "event.place",
                          {{"way", fmt::format("{}", event.way_id)},
                           {"at", report.wording.short_length(event.at_m)}});
}

Table table_of(const Report& report) {
    const auto& say = report.wording;
    Table table{say("event.caption"),
                {{say("event.kind")},
                 {say("event.severity")},
                 {say("event.size_mm"), true},
                 {say("column.road")},
                 {say("event.chainage"), true, true},
                 {say("event.position"), true},
                 {say("column.passes"), true},
                 {say("event.last_seen"), true, true}},
                {}};
    for (const auto& event : report.events) {
        const auto size =
            fmt::format("{} ± {}", say.small_size(event.size_mm), say.small_size(event.sd_mm));
        table.rows.push_back(
            {say(fmt::format("event.{}", name_of(event.kind))),
             say(fmt::format("event.{}", name_of(severity_of(event.size_mm)))),
             size,
             event.name.empty() ? kind_name(report, event.highway) : isolated(event.name),
             position_text(report, event),
             fmt::format("{:.5f}, {:.5f}", event.at.lat_deg, event.at.lon_deg),
             say("event.share",
                 {{"passes", fmt::format("{}", event.passes)},
                  {"over", fmt::format("{}", event.passes_over)}}),
             event.last_seen.empty() ? "–" : say.day(event.last_seen)});
    }
    return table;
}

} // namespace

DocumentSection events_section(const Report& report) {
    const auto& say = report.wording;
    DocumentSection section{say("event"), {}};
    section.blocks.emplace_back(
        Paragraph{say(report.publication ? "event.about.crowd" : "event.about") + " " +
                  say.counted("event.found", report.events_found) + " " +
                  say.counted("event.listed", report.events.size())});
    section.blocks.emplace_back(table_of(report));
    section.blocks.emplace_back(Paragraph{say("event.remark"), true});
    return section;
}

} // namespace macadam
