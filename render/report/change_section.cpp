#include "render/report/common_parts.hpp"
#include "render/report/sections.hpp"

#include "estimator/common/statistics.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

namespace macadam {

using namespace document;

namespace {

constexpr double by_chance = 0.05; // past 1.96 sd, either side

/// Builds an id such as "worse-1"; `side` is "worse" or "better", as in ids and keys of the
/// catalogue.
std::string id_of(const std::string& side, std::size_t rank) {
    return fmt::format("{}-{}", side, rank);
}

Table lengths_table(const Report& report) {
    const auto& say = report.wording;
    const auto& change = report.change->change;
    Table table{say("change.caption", {{"unit", std::string{say.iri_unit()}}}),
                {{say("column.kind")},
                 {say("column.deteriorated"), true},
                 {say("column.no_change"), true},
                 {say("column.improved"), true},
                 {say("column.before_alone"), true},
                 {say("column.since_alone"), true},
                 {say("column.mean_change"), true},
                 {say("column.interval"), true}},
                {}};
    const auto& all = change.all;
    const double longest_m = all.improved_m + all.unchanged_m + all.deteriorated_m +
                             all.before_alone_m + all.since_alone_m;
    const auto add = [&](const ChangeLengths& lengths, const std::string& name) {
        const auto& mean = lengths.mean;
        const double reach = normal_interval_90 * mean.sd;
        const bool known = mean.length_m > 0;
        table.rows.push_back(
            {name,
             say.road_length(lengths.deteriorated_m, longest_m),
             say.road_length(lengths.unchanged_m, longest_m),
             say.road_length(lengths.improved_m, longest_m),
             say.road_length(lengths.before_alone_m, longest_m),
             say.road_length(lengths.since_alone_m, longest_m),
             known ? say.iri_change(mean.mm_per_m) : "–",
             known ? say.change_interval(mean.mm_per_m - reach, mean.mm_per_m + reach) : "–"});
    };
    for (const auto& kind : change.kinds) {
        add(kind, kind_name(report, kind.kind));
    }
    add(all, say("all"));
    table.sum = true;
    table.stacks = true;
    return table;
}

Table stretches_table(const Report& report,
                      const std::vector<ReportChangedStretch>& stretches,
                      const std::string& side) {
    const auto& say = report.wording;
    Table table{say("change." + side + ".caption", {{"unit", std::string{say.iri_unit()}}}),
                {{say("column.rank"), true},
                 {say("column.road")},
                 {say("column.towards")},
                 {say("column.length_m"), true},
                 {say("column.before"), true, true},
                 {say("column.since"), true, true},
                 {say("column.change"), true},
                 {say("column.interval"), true, true}},
                {}};
    for (const auto& [changed, heading, map] : stretches) {
        const auto rank = table.rows.size() + 1;
        table.rows.push_back(
            {RichText{{{fmt::format("{}", rank), SpanLook::plain, false, id_of(side, rank)}}},
             road_name(report, changed.stretch),
             say.or_else("heading." + heading, heading),
             say.short_length(changed.stretch.length_m),
             say.iri(changed.before.iri),
             say.iri(changed.after.iri),
             say.iri_change(changed.difference.mm_per_m),
             say.change_interval(changed.low, changed.high)});
    }
    return table;
}

Card card_of(const Report& report,
             const ReportChangedStretch& of,
             const std::string& side,
             std::size_t rank) {
    const auto& say = report.wording;
    const auto& stretch = of.stretch.stretch;
    const auto name = road_name(report, stretch);
    return {id_of(side, rank),
            of.map,
            say("stretch.words", {{"rank", fmt::format("{}", rank)}, {"road", name}}),
            say("stretch.title",
                {{"rank", fmt::format("{}", rank)},
                 {"road", name},
                 {"heading", say.or_else("heading." + of.heading, of.heading)}}),
            std::vector<Span>{
                {"IRI " + say.iri_change(of.stretch.difference.mm_per_m), SpanLook::strong},
                {say("change.mean",
                     {{"interval", say.change_interval(of.stretch.low, of.stretch.high)},
                      {"before", say.iri(of.stretch.before.iri)},
                      {"since", say.iri(of.stretch.after.iri)},
                      {"length", say.short_length(stretch.length_m)}})},
                {"\n" + say("stretch.place",
                            {{"reference", reference_text(report, stretch)},
                             {"lat", fmt::format("{:.5f}", stretch.middle.lat_deg)},
                             {"lon", fmt::format("{:.5f}", stretch.middle.lon_deg)}})}}};
}

void add_stretches(DocumentSection& section,
                   const Report& report,
                   const std::vector<ReportChangedStretch>& stretches,
                   const std::string& side) {
    const auto& say = report.wording;
    if (stretches.empty()) {
        section.blocks.emplace_back(Paragraph{
            say("change." + side + ".none",
                {{"least", say.short_length(report.change->change.config.min_length_m)}})});
        return;
    }
    section.blocks.emplace_back(stretches_table(report, stretches, side));
    Cards cards;
    for (std::size_t i = 0; i < stretches.size(); ++i) {
        cards.cards.push_back(card_of(report, stretches[i], side, i + 1));
    }
    section.blocks.emplace_back(std::move(cards));
}

Legend legend_of(const Report& report) {
    const auto& say = report.wording;
    const auto entry = [&](Verdict verdict, std::string_view word) {
        const auto i = static_cast<std::size_t>(verdict);
        return LegendEntry{
            report.change->colours[i], say(word), "", report.change->dark_colours[i]};
    };
    Legend legend{say("change.legend"), {}};
    legend.entries.push_back(entry(Verdict::deteriorated, "column.deteriorated"));
    legend.entries.push_back(entry(Verdict::no_change_shown, "column.no_change"));
    legend.entries.push_back(entry(Verdict::improved, "column.improved"));
    legend.entries.push_back({std::nullopt, say("change.not_comparable"), ""});
    return legend;
}

} // namespace

DocumentSection change_section(const Report& report) {
    const auto& say = report.wording;
    const auto& change = report.change->change;
    const auto day = say.day(report.change->since);
    DocumentSection section{say("change", {{"day", day}}), {}};
    if (change.segments.empty()) {
        section.blocks.emplace_back(Paragraph{say("change.nothing", {{"day", day}})});
        return section;
    }
    const auto compared = change.segments.size();
    section.blocks.emplace_back(Paragraph{say("change.about",
                                              {{"day", day},
                                               {"compared", say.counted("segments", compared)},
                                               {"alone", say.count(change.called_alone)},
                                               {"chance",
                                                say.count(static_cast<std::size_t>(std::lround(
                                                    by_chance * static_cast<double>(compared))))},
                                               {"share", say.percent(change.config.rate, 1)}})});
    section.blocks.emplace_back(lengths_table(report));
    section.blocks.emplace_back(Paragraph{say("change.remark"), true});
    section.blocks.emplace_back(legend_of(report));
    section.blocks.emplace_back(map_figure(report,
                                           report.change->map,
                                           report.change->map_width_m,
                                           say("change.words", {{"day", day}})));
    add_stretches(section, report, report.change->worse, "worse");
    add_stretches(section, report, report.change->better, "better");
    return section;
}

} // namespace macadam
