#include "render/report/common_parts.hpp"
#include "render/report/sections.hpp"
#include "render/report/strip_chart.hpp"

#include <fmt/format.h>

#include <cmath>

namespace macadam {

using namespace document;

namespace {

std::string id_of(std::size_t rank) {
    return fmt::format("stretch-{}", rank);
}

Table table_of(const Report& report) {
    const auto& say = report.wording;
    Table table{say("worst.caption", {{"unit", std::string{say.iri_unit()}}}),
                {{say("column.rank"), true},
                 {say("column.road")},
                 {say("column.towards")},
                 {say("column.length_m"), true},
                 {"IRI", true},
                 {say("column.interval"), true, true},
                 {say("column.worst_segment"), true, true},
                 {say("column.passes"), true, true},
                 {say("column.cars"), true, true}},
                {}};
    for (const auto& [stretch, heading, seen, map, strip, photos] : report.worst) {
        const auto rank = table.rows.size() + 1;
        table.rows.push_back(
            {RichText{{{fmt::format("{}", rank), SpanLook::plain, false, id_of(rank)}}},
             road_name(report, stretch),
             say.or_else("heading." + heading, heading),
             say.short_length(stretch.length_m),
             say.iri(stretch.mean.iri),
             say.interval(stretch.mean),
             say.iri(stretch.worst_iri),
             passes_text(say, stretch.min_passes, stretch.median_passes),
             fmt::format("{}", stretch.vehicles)});
    }
    return table;
}

/// Adds links to the midpoint for readers' own maps: nothing is loaded unless they follow one.
void add_links(Card& card, const Report& report, const WorstSection& stretch) {
    Span geo{report.wording("stretch.app")};
    geo.address = fmt::format("geo:{:.5f},{:.5f}", stretch.middle.lat_deg, stretch.middle.lon_deg);
    card.text.spans.push_back({" · "});
    card.text.spans.push_back(std::move(geo));
    if (report.attribution.find("OpenStreetMap") != std::string::npos) {
        Span osm{"OpenStreetMap"};
        osm.address = fmt::format("https://www.openstreetmap.org/?mlat={0:.5f}&mlon={1:.5f}"
                                  "#map=18/{0:.5f}/{1:.5f}",
                                  stretch.middle.lat_deg,
                                  stretch.middle.lon_deg);
        card.text.spans.push_back({" · "});
        card.text.spans.push_back(std::move(osm));
    }
}

Card card_of(const Report& report, const ReportStretch& of, std::size_t rank) {
    const auto& say = report.wording;
    const auto& stretch = of.stretch;
    const auto name = road_name(report, stretch);
    const auto period = say.period(of.seen.first, of.seen.last);
    const auto passes = passes_text(say, stretch.min_passes, stretch.median_passes);
    Card card{id_of(rank),
              of.map,
              say("stretch.words", {{"rank", fmt::format("{}", rank)}, {"road", name}}),
              say("stretch.title",
                  {{"rank", fmt::format("{}", rank)},
                   {"road", name},
                   {"heading", say.or_else("heading." + of.heading, of.heading)}}),
              std::vector<Span>{
                  {"IRI " + say.iri(stretch.mean.iri), SpanLook::strong},
                  {say("stretch.mean",
                       {{"interval", say.interval(stretch.mean)},
                        {"length", say.short_length(stretch.length_m)}})},
                  {say.counted(
                       "stretch.phone",
                       static_cast<std::size_t>(std::lround(stretch.median_passes)),
                       {{"worst", say.iri(stretch.worst_iri)},
                        {"passes", passes},
                        {"cars", say.counted("cars", static_cast<std::size_t>(stretch.vehicles))}}),
                   SpanLook::phone},
                  {"\n" + say("stretch.place",
                              {{"reference", reference_text(report, stretch)},
                               {"lat", fmt::format("{:.5f}", stretch.middle.lat_deg)},
                               {"lon", fmt::format("{:.5f}", stretch.middle.lon_deg)}})}}};
    add_links(card, report, stretch);
    card.text.spans.push_back(
        {"\n" +
         (period.empty() ? say("stretch.undated") : say("stretch.driven", {{"period", period}}))});
    if (!of.strip.empty()) {
        Strip strip{0,
                    of.strip.back().to_m,
                    {{say("column.iri_in", {{"unit", std::string{say.iri_unit()}}}), of.strip}}};
        card.chart =
            strip_drawing(report, strip, strip_on_card, say("strip.words", {{"road", name}}));
    }
    for (const auto& photo : of.photos) {
        card.photos.push_back(photo_of(report, photo, name));
    }
    return card;
}

} // namespace

DocumentSection worst_section(const Report& report) {
    const auto& say = report.wording;
    DocumentSection section{say("worst"), {}};
    const Values values{{"least", say.short_length(report.min_stretch_m)},
                        {"border", say.iri_with_unit(report.poor_above_mm_per_m)}};
    if (report.worst.empty()) {
        section.blocks.emplace_back(Paragraph{say("worst.none", values)});
        return section;
    }
    section.blocks.emplace_back(Paragraph{say("worst.about", values) + " " +
                                          say.counted("worst.found", report.stretches, values) +
                                          " " + say.counted("worst.listed", report.worst.size())});
    section.blocks.emplace_back(table_of(report));
    section.blocks.emplace_back(Paragraph{say("worst.remark"), true});
    Cards cards;
    for (std::size_t i = 0; i < report.worst.size(); ++i) {
        cards.cards.push_back(card_of(report, report.worst[i], i + 1));
    }
    section.blocks.emplace_back(std::move(cards));
    return section;
}

} // namespace macadam
