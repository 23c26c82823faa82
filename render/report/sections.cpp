#include "render/report/sections.hpp"

#include "render/report/common_parts.hpp"
#include "render/report/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {

using namespace document;

namespace {

/// Returns the index of the first poor class, or the number of classes if there is none.
std::size_t first_poor(const Report& report) {
    std::size_t c = 1;
    while (c < report.colours.size() &&
           report.classes->classes[c - 1].to_mm_per_m < report.poor_above_mm_per_m) {
        ++c;
    }
    return std::min(c, report.colours.size());
}

/// Returns the length in the poor classes.
double poor_m(const Report& report) {
    double length_m = 0;
    for (std::size_t c = first_poor(report); c < report.colours.size(); ++c) {
        length_m += report.summary.all.classes[c].length_m;
    }
    return length_m;
}

/// Returns the definition of poor by the names of the classes.
std::string poor_words(const Report& report) {
    const auto last = report.colours.size() - 1;
    const auto first = first_poor(report);
    const auto name = class_name(report, std::min(first, last));
    return first < last ? report.wording("key.poor.or_worse", {{"class", name}}) : name;
}

/// Returns true if the report also gives in/mi beside mm/m; reports in in/mi give that unit only.
bool says_both_units(const Report& report) {
    return report.wording.unit == IriUnit::mm_per_m;
}

Localisation in_inches(Localisation wording) {
    wording.unit = IriUnit::in_per_mi;
    return wording;
}

KeyNumber measured_key(const Report& report) {
    const auto& say = report.wording;
    const auto& all = report.summary.all;
    return {say("key.measured"),
            say.road_length(all.covered_m, all.covered_m) + " " + say.long_unit(),
            say("key.measured.more",
                {{"share", say.percent(all.covered_m, all.network_m)},
                 {"km", say.road_length(all.network_m, all.network_m)}})};
}

KeyNumber mean_key(const Report& report) {
    const auto& say = report.wording;
    const auto& mean = report.summary.all.mean;
    std::vector<Span> more{{say("key.mean.more") + " "},
                           {say.interval(mean), SpanLook::plain, true}};
    if (says_both_units(report)) {
        more.push_back({"; " + in_inches(say).iri_with_unit(mean.iri)});
    }
    return {say("key.mean"), say.iri_with_unit(mean.iri), more};
}

KeyNumber poor_key(const Report& report) {
    const auto& say = report.wording;
    const auto& all = report.summary.all;
    return {poor_words(report),
            say.percent(poor_m(report), all.covered_m),
            say("key.poor.more",
                {{"km", say.road_length(poor_m(report), all.covered_m)},
                 {"border", say.iri_with_unit(report.poor_above_mm_per_m)}})};
}

KeyNumber stretches_key(const Report& report) {
    const auto& say = report.wording;
    return {say("key.stretches"),
            say.count(report.stretches),
            say("key.stretches.more",
                {{"least", say.short_length(report.min_stretch_m)},
                 {"km", say.road_length(report.stretches_m, report.summary.all.covered_m)}})};
}

KeyNumber cars_key(const Report& report) {
    const auto& say = report.wording;
    if (const auto& crowd = report.publication) {
        return {say("key.cars"),
                say("key.cars.least", {{"cars", say.counted("cars", crowd->cars)}}),
                say("key.cars.more",
                    {{"trips", say.counted("trips", crowd->trips)},
                     {"passes", say.counted("passes_over_segments", crowd->passes)}})};
    }
    const auto total = total_of(report.vehicles);
    return {say("key.cars"),
            say.counted("cars", cars_in(report.vehicles)),
            say("key.cars.more",
                {{"trips", say.counted("trips", total.trips)},
                 {"passes", say.counted("passes_over_segments", total.passes)}})};
}

Table classes_table(const Report& report) {
    const auto& say = report.wording;
    const auto& all = report.summary.all;
    Table table{say("classes.caption"), {{say("column.class")}}, {}};
    table.columns.push_back({say("column.iri_in", {{"unit", std::string{say.iri_unit()}}}), true});
    if (says_both_units(report)) {
        table.columns.push_back({"in/mi", true, true});
    }
    table.columns.insert(
        table.columns.end(),
        {{say.long_unit(), true}, {say("column.share"), true}, {say("column.range_of_km"), true}});
    for (std::size_t c = 0; c < report.colours.size(); ++c) {
        const auto& range = all.classes[c];
        Cell name{RichText{{{class_name(report, c), SpanLook::plain, true}}}};
        name.swatch = report.colours[c];
        std::vector<Cell> row{name, class_range(report, say, c)};
        if (says_both_units(report)) {
            row.emplace_back(class_range(report, in_inches(say), c));
        }
        row.emplace_back(say.road_length(range.length_m, all.covered_m));
        row.emplace_back(say.percent(range.length_m, all.covered_m));
        row.emplace_back(fmt::format("{} – {}",
                                     say.road_length(range.low_m, all.covered_m),
                                     say.road_length(range.high_m, all.covered_m)));
        table.rows.push_back(std::move(row));
    }
    return table;
}

/// Adds a row for each kind of road that was measured, and one for all roads.
template <typename RowOf>
Table with_kinds(Table table, const Report& report, const RowOf& row_of) {
    for (const auto& roads : report.summary.kinds) {
        if (roads.covered_m > 0) {
            table.rows.push_back(row_of(roads, kind_name(report, roads.kind)));
        }
    }
    table.rows.push_back(row_of(report.summary.all, report.wording("all")));
    table.sum = true;
    table.stacks = true;
    return table;
}

Table kinds_table(const Report& report) {
    const auto& say = report.wording;
    const auto& all = report.summary.all;
    Table table{say("kinds.caption", {{"unit", std::string{say.iri_unit()}}}),
                {{say("column.kind")},
                 {say.long_unit(), true},
                 {say("column.mean"), true},
                 {say("column.interval"), true},
                 {say("column.median"), true},
                 {"P85", true},
                 {"P95", true},
                 {say("column.classes")}},
                {}};
    const auto row_of = [&](const RoadSummary& roads, const std::string& name) {
        return std::vector<Cell>{name,
                                 say.road_length(roads.covered_m, all.covered_m),
                                 say.iri(roads.mean.iri),
                                 say.interval(roads.mean),
                                 say.iri(roads.p50),
                                 say.iri(roads.p85),
                                 say.iri(roads.p95),
                                 share_bar(report, roads)};
    };
    return with_kinds(std::move(table), report, row_of);
}

/// Builds a table of the length of each class by kind of road, with its uncertainty.
Table kind_classes_table(const Report& report) {
    const auto& say = report.wording;
    const auto& all = report.summary.all;
    Table table{say("kind_classes.caption"), {{say("column.kind")}}, {}};
    for (std::size_t c = 0; c < report.colours.size(); ++c) {
        table.columns.push_back({class_name(report, c), true});
    }
    const auto row_of = [&](const RoadSummary& roads, const std::string& name) {
        std::vector<Cell> row{name};
        for (const auto& range : roads.classes) {
            row.emplace_back(RichText{{{say.road_length(range.length_m, all.covered_m) + " "},
                                       {fmt::format("({} – {})",
                                                    say.road_length(range.low_m, all.covered_m),
                                                    say.road_length(range.high_m, all.covered_m)),
                                        SpanLook::quiet,
                                        true}}});
        }
        return row;
    };
    return with_kinds(std::move(table), report, row_of);
}

/// Adds words, names of options in one piece each: "--way" has no break after its hyphens.
void add_with_options(std::vector<Span>& text, std::string_view words) {
    while (!words.empty()) {
        const auto word = words.substr(0, words.find(' ', words.front() == ' ' ? 1 : 0));
        const bool is_option = word.starts_with(" --");
        if (is_option) {
            text.push_back({" "});
        }
        text.push_back({std::string{word.substr(is_option ? 1 : 0)}, SpanLook::plain, is_option});
        words.remove_prefix(word.size());
    }
}

} // namespace

RichText subtitle_of(const Report& report) {
    const auto& say = report.wording;
    const auto period = say.period(report.period.first, report.period.last);
    const auto about = say("head.about") + " ";
    const bool is_empty =
        report.publication ? report.publication->trips == 0 : total_of(report.vehicles).trips == 0;
    if (is_empty) {
        return about + say("head.nothing");
    }
    std::vector<Span> text{{about + say(period.empty() ? "head.undated" : "head.driven")}};
    if (!period.empty()) {
        text.insert(text.end(), {{" "}, {period, SpanLook::plain, true}});
        text.push_back({period.ends_with('.') ? "" : "."}); // a date may end with one
    }
    if (!report.selection.empty()) {
        add_with_options(text, " " + say("head.selection", {{"options", report.selection}}));
    }
    return text;
}

KeyNumbers key_numbers(const Report& report) {
    KeyNumbers keys{{measured_key(report)}};
    if (report.summary.all.covered_m > 0) {
        keys.numbers.push_back(mean_key(report));
        keys.numbers.push_back(poor_key(report));
        keys.numbers.push_back(stretches_key(report));
    }
    keys.numbers.push_back(cars_key(report));
    return keys;
}

DocumentSection condition_section(const Report& report) {
    const auto& say = report.wording;
    return {say("condition"),
            {classes_table(report),
             kinds_table(report),
             kind_classes_table(report),
             Paragraph{say("condition.remark"), true}}};
}

RichText lead_of(const Report& report) {
    const auto& say = report.wording;
    const auto& all = report.summary.all;
    if (all.covered_m <= 0) {
        return {};
    }
    const auto share = say.whole_percent(poor_m(report), all.covered_m);
    if (report.worst.empty()) {
        return say(poor_m(report) > 0 ? "lead.poor" : "lead.good", {{"share", share}});
    }
    const auto& first = report.worst.front();
    std::vector<Span> text{
        {say("lead.begin", {{"share", share}}) + " "},
        {road_name(report, first.stretch), SpanLook::strong, false, "stretch-1"},
        {say("lead.where",
             {{"length", say.short_length(first.stretch.length_m)},
              {"heading", say.or_else("heading." + first.heading, first.heading)},
              {"iri", say.iri_with_unit(first.stretch.mean.iri)}})}};
    return text;
}

Overview overview_of(const Report& report) {
    const auto& say = report.wording;
    const auto& all = report.summary.all;
    Legend legend{report.words.title ? *report.words.title + ":"
                                     : say("map.legend", {{"unit", std::string{say.iri_unit()}}}),
                  {}};
    std::string words = say("map.words");
    for (std::size_t c = 0; c < report.colours.size(); ++c) {
        const auto name = class_name(report, c);
        legend.entries.push_back({report.colours[c], name, class_range(report, say, c)});
        words += fmt::format("{} {} {} {}",
                             c == 0 ? say("map.words.classes") : ",",
                             name,
                             say.road_length(all.classes[c].length_m, all.covered_m),
                             say.long_unit());
    }
    if (const auto& few = report.few_passes) {
        legend.entries.push_back({few->rgb, few_passes_words(report), "", few->dark_rgb});
    }
    legend.entries.push_back({std::nullopt, unmeasured_words(report), ""});
    auto figure = map_figure(report, report.map, report.map_width_m, words);
    const auto grey = report.few_passes ? say("map.few_passes.remark") + " " : "";
    figure.caption = fmt::format("{} {}{}", say("map.remark"), grey, figure.caption);
    Overview overview{std::move(legend), std::move(figure)};
    if (all.covered_m > 0) {
        overview.distribution = histogram_drawing(report, histogram_in_a_column);
        overview.wide_distribution = histogram_drawing(report, histogram_over_a_page);
    }
    return overview;
}

DocumentSection coverage_section(const Report& report) {
    const auto& say = report.wording;
    const auto& all = report.summary.all;
    Table table{say("coverage.caption"),
                {{say("column.kind")},
                 {say("column.on_map"), true},
                 {say("column.one_pass"), true},
                 {say("column.share"), true},
                 {say("column.three_passes"), true},
                 {say("column.share"), true}},
                {}};
    const auto add = [&](const RoadSummary& roads, const std::string& name) {
        table.rows.push_back({name,
                              say.road_length(roads.network_m, all.network_m),
                              say.road_length(roads.covered_m, all.network_m),
                              say.percent(roads.covered_m, roads.network_m),
                              say.road_length(roads.thrice_m, all.network_m),
                              say.percent(roads.thrice_m, roads.network_m)});
    };
    for (const auto& roads : report.summary.kinds) {
        add(roads, kind_name(report, roads.kind));
    }
    add(all, say("all"));
    table.sum = true;
    return {
        say("coverage"),
        {table,
         Paragraph{say("coverage.remark",
                       {{"passed", say.count(report.segments_with_passes)},
                        {"segments", say.count(report.segments)},
                        {"length",
                         say.unit == IriUnit::in_per_mi ? say.short_length(report.segment_length_m)
                                                        : say.shortest(report.segment_length_m)}}),
                   true}}};
}

} // namespace macadam
