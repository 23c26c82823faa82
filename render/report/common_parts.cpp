#include "render/report/common_parts.hpp"

#include "render/scene/isolated_text.hpp"
#include "render/scene/scale_bar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

/// Returns true if the style overrides the default word.
bool is_own(const Report& report, std::string LegendWords::*word) {
    return report.words.*word != LegendWords{}.*word;
}

/// Replaces the {} in the words by a value.
std::string with_value(std::string words, const std::string& value) {
    const auto place = words.find("{}");
    return place == std::string::npos ? words : words.replace(place, 2, value);
}

} // namespace

std::string sentence_case(std::string_view name) {
    std::string text{name};
    std::ranges::replace(text, '_', ' ');
    if (!text.empty() && 'a' <= text[0] && text[0] <= 'z') {
        text[0] = static_cast<char>(text[0] - 'a' + 'A');
    }
    return text;
}

std::string kind_name(const Report& report, std::string_view kind) {
    return report.wording.or_else(fmt::format("kind.{}", kind), sentence_case(kind));
}

std::string class_name(const Report& report, std::size_t i) {
    const auto name = report.classes->classes[i].name;
    return report.wording.or_else(fmt::format("class.{}", name), sentence_case(name));
}

std::string class_range(const Report& report, const Localisation& wording, std::size_t i) {
    const auto& rows = report.classes->classes;
    const bool last = std::isinf(rows[i].to_mm_per_m);
    if (i > 0 && !last) {
        return wording.range(*report.classes, i);
    }
    const std::size_t border = i > 0 ? i - 1 : 0;
    const bool open = rows[border].open;
    const auto words = i == 0 ? (last   ? &LegendWords::all
                                 : open ? &LegendWords::below
                                        : &LegendWords::up_to)
                       : open ? &LegendWords::from
                              : &LegendWords::above;
    return is_own(report, words)
               ? with_value(report.words.*words, wording.iri(rows[border].to_mm_per_m))
               : wording.range(*report.classes, i);
}

std::string few_passes_words(const Report& report) {
    const auto least = report.wording.count(
        static_cast<std::size_t>(report.few_passes ? report.few_passes->min_passes : 1));
    return is_own(report, &LegendWords::few_passes)
               ? with_value(report.words.few_passes, least)
               : report.wording("map.few_passes", {{"least", least}});
}

std::string unmeasured_words(const Report& report) {
    return is_own(report, &LegendWords::unmeasured) ? report.words.unmeasured
                                                    : report.wording("map.unmeasured");
}

std::string road_name(const Report& report, const WorstSection& stretch) {
    if (!stretch.name.empty()) {
        return isolated(stretch.name);
    }
    const auto kind =
        stretch.highway.empty() ? std::string_view{"other"} : road_kind(stretch.highway);
    return report.wording(fmt::format("unnamed.{}", kind));
}

std::string reference_text(const Report& report, const WorstSection& stretch) {
    const bool of_osm = report.attribution.find("OpenStreetMap") != std::string::npos;
    std::string text;
    for (const auto& [way_id, forward, from_m, to_m] : stretch.parts) {
        text += text.empty() ? "" : "; ";
        text += report.wording(of_osm ? "stretch.part_osm" : "stretch.part",
                               {{"way", fmt::format("{}", way_id)},
                                {"from", report.wording.short_length(forward ? from_m : to_m)},
                                {"to", report.wording.short_length(forward ? to_m : from_m)}});
    }
    return text;
}

std::string passes_text(const Localisation& wording, std::int32_t least, double median) {
    return least == median ? fmt::format("{}", least)
                           : fmt::format("{} – {}", least, wording.shortest(median));
}

document::Photo photo_of(const Report& report, const ReportPhoto& photo, const std::string& road) {
    const auto& say = report.wording;
    const auto distance = say.short_length(photo.distance_m);
    return {photo.jpeg,
            photo.width_px,
            photo.height_px,
            say("photo.words", {{"road", road}}),
            photo.day.empty()
                ? say("photo.undated", {{"distance", distance}})
                : say("photo", {{"day", say.day(photo.day)}, {"distance", distance}})};
}

document::MapFigure map_figure(const Report& report,
                               const ReportPicture& picture,
                               double width_m,
                               const std::string& words) {
    constexpr double max_percent = 30;
    document::MapFigure figure{picture, words, 0, "", report.attribution};
    if (width_m > 0) {
        const auto bar =
            scale_bar(width_m / 100,
                      max_percent,
                      report.wording.unit == IriUnit::in_per_mi); // in percent, not pixels
        figure.scale_percent = bar.width_px;
        figure.scale = report.wording("map.scale", {{"length", bar.label}});
    }
    return figure;
}

document::PageWords page_words(const Localisation& wording, bool contents) {
    return {.contents = contents ? wording("contents") : "",
            .download_csv = wording("table.csv"),
            .sort_by = *find_message(*wording.language, "table.sort"),
            .decimal_mark = *find_message(*wording.language, "locale.decimal_mark")};
}

std::size_t cars_in(const std::vector<ReportVehicle>& vehicles) {
    std::vector<std::string> names;
    for (const auto& vehicle : vehicles) {
        names.push_back(vehicle.name);
    }
    std::ranges::sort(names);
    return static_cast<std::size_t>(std::ranges::unique(names).begin() - names.begin());
}

ReportVehicle total_of(const std::vector<ReportVehicle>& vehicles) {
    ReportVehicle total;
    for (const auto& vehicle : vehicles) {
        total.trips += vehicle.trips;
        total.undated_trips += vehicle.undated_trips;
        total.passes += vehicle.passes;
        total.km += vehicle.km;
        total.matched_km += vehicle.matched_km;
        total.rows_read += vehicle.rows_read;
        total.rows_used += vehicle.rows_used;
    }
    return total;
}

} // namespace macadam
