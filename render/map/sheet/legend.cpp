#include "render/map/sheet/legend.hpp"

#include "render/map/sheet/event_symbols.hpp"
#include "render/scene/unbroken_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

// Sizes at 1000 px.
constexpr double text_px = 15;
constexpr double title_px = 15;
constexpr double row_px = 25;
constexpr double padding_px = 16;
constexpr double swatch_px = 34;
constexpr double gap_px = 12;
constexpr double note_px = 12.5;
constexpr double note_row_px = 17;
constexpr double min_note_width_px = 270;
constexpr double core_px = 7;
constexpr double casing_px = 1.7;

constexpr double km_per_mi = 1.609344;

/// Returns the number of decimals that keeps the table's borders in mm/m exact, at most two.
int decimals_of(const ClassTable& table) {
    for (const int decimals : {0, 1}) {
        const double scale = std::pow(10.0, decimals);
        const auto is_short = [&](const IriClass& row) {
            const double value = row.to_mm_per_m * scale;
            return std::isinf(value) || std::abs(value - std::round(value)) < 1e-6;
        };
        if (std::ranges::all_of(table.classes, is_short)) {
            return decimals;
        }
    }
    return 2;
}

/// Replaces the {} in the words by a value.
std::string with_value(std::string words, const std::string& value) {
    const auto place = words.find("{}");
    return place == std::string::npos ? words : words.replace(place, 2, value);
}

/// Returns the values of a class; "" if the classes have no borders.
std::string range_of(const ClassTable& table, std::size_t i, const MapStyle& style) {
    if (std::isnan(table.classes[i].to_mm_per_m)) {
        return {};
    }
    const bool in_per_mi = style.in_per_mi;
    const auto& words = style.words;
    const double scale = in_per_mi ? in_per_mi_of_mm_per_m : 1;
    const int decimals = in_per_mi ? 0 : decimals_of(table);
    const auto number = [&](std::size_t row) {
        return fmt::format("{:.{}f}", table.classes[row].to_mm_per_m * scale, decimals);
    };
    const bool last = std::isinf(table.classes[i].to_mm_per_m);
    if (i == 0) {
        return last ? words.all
                    : with_value(table.classes[i].open ? words.below : words.up_to, number(i));
    }
    if (last) {
        return with_value(table.classes[i - 1].open ? words.from : words.above, number(i - 1));
    }
    return number(i - 1) + " – " + number(i);
}

std::string length_text(double km, bool miles) {
    const double length = miles ? km / km_per_mi : km;
    return fmt::format("{:.{}f} {}", length, length < 100 ? 1 : 0, miles ? "mi" : "km");
}

std::string capitalised(std::string_view name) {
    std::string text{name};
    if (!text.empty() && 'a' <= text[0] && text[0] <= 'z') {
        text[0] = char(text[0] - 'a' + 'A');
    }
    return text;
}

std::string title_of(const MapStyle& style) {
    if (style.words.title) {
        return *style.words.title;
    }
    return style.in_per_mi ? "Roughness, IRI in in/mi" : "Roughness, IRI in mm/m";
}

void draw_swatch(DrawTarget& canvas,
                 const LegendEntry& entry,
                 const PixelPoint& middle,
                 double unit,
                 const Palette& colours) {
    const double half_px = (swatch_px - core_px) / 2 * unit;
    if (entry.swatch == LegendEntry::Swatch::event) {
        const MapEvent symbol{{}, entry.event, Severity::moderate};
        draw_event(canvas, symbol, middle, unit, colours);
        return;
    }
    const PixelPoint from{middle.x - half_px, middle.y};
    const PixelPoint to{middle.x + half_px, middle.y};
    const double radius_px = core_px / 2 * unit;
    if (entry.swatch == LegendEntry::Swatch::unmeasured) {
        canvas.stroke(from, to, radius_px * 0.6, entry.rgb);
        return;
    }
    const bool certain = entry.swatch == LegendEntry::Swatch::certain;
    const double core_radius_px = certain ? radius_px : radius_px * 0.55;
    canvas.stroke(from, to, core_radius_px + std::max(1.0, casing_px * unit), colours.casing);
    canvas.stroke(from, to, core_radius_px, entry.rgb);
}

/// Adds the kinds of events in the scene.
void add_events(const MapScene& scene, Legend& legend) {
    for (const auto kind :
         {EventKind::pothole, EventKind::bump, EventKind::joint, EventKind::rail}) {
        const auto count = std::ranges::count(scene.events, kind, &MapEvent::kind);
        if (count > 0) {
            legend.entries.push_back({.swatch = LegendEntry::Swatch::event,
                                      .rgb = 0,
                                      .name = capitalised(name_of(kind)),
                                      .range = {},
                                      .length = {},
                                      .event = kind});
        }
    }
}

} // namespace

Legend legend_of(const MapScene& scene, const MapStyle& style, const ClassTable& classes) {
    if (!style.legend) {
        return {};
    }
    const auto colours = class_colours(style, classes.classes.size());
    Legend legend{.title = title_of(style), .entries = {}, .note = style.words.note};
    for (std::size_t i = 0; i < classes.classes.size(); ++i) {
        legend.entries.push_back({.rgb = colours[i],
                                  .name = capitalised(classes.classes[i].name),
                                  .range = range_of(classes, i, style),
                                  .length = i < scene.class_km.size()
                                                ? length_text(scene.class_km[i], style.in_per_mi)
                                                : std::string{}});
    }
    const auto measured = [](const MapLine& line) { return line.iri_class >= 0; };
    const auto is_grey = [&](const MapLine& line) { return measured(line) && line.few_passes; };
    if (std::ranges::any_of(scene.lines, is_grey)) {
        legend.entries.push_back(
            {.rgb = palette(style).few_passes,
             .name = with_value(style.words.few_passes, fmt::format("{}", style.min_passes)),
             .range = {},
             .length = {}});
    }
    if (std::ranges::any_of(scene.lines, [&](const MapLine& line) {
            return measured(line) && !line.few_passes && !line.certain;
        })) {
        legend.entries.push_back({.swatch = LegendEntry::Swatch::uncertain,
                                  .rgb = colours[colours.size() / 2],
                                  .name = style.words.uncertain,
                                  .range = {},
                                  .length = {}});
    }
    if (!std::ranges::all_of(scene.lines, measured)) {
        legend.entries.push_back({.swatch = LegendEntry::Swatch::unmeasured,
                                  .rgb = palette(style).unmeasured,
                                  .name = style.words.unmeasured,
                                  .range = {},
                                  .length = {}});
    }
    add_events(scene, legend);
    return legend;
}

std::vector<Legend> forms_of(const Legend& legend) {
    auto without_lengths = legend;
    without_lengths.note.clear();
    for (auto& entry : without_lengths.entries) {
        entry.length.clear();
    }
    auto values = without_lengths;
    for (auto& entry : values.entries) {
        if (!entry.range.empty()) {
            entry.name = std::exchange(entry.range, {});
        }
    }
    return {legend, without_lengths, values};
}

LegendCard legend_card(const Legend& legend, int columns, double unit, TypeSetter& setter) {
    LegendCard card{.legend = legend, .columns = columns, .unit = unit};
    const TextLook look{text_px * unit};
    double alone_px = 0; // names without a range and a length may use their columns
    for (const auto& entry : legend.entries) {
        const double name_px = setter.width_px(entry.name, look);
        auto& column_px = entry.range.empty() && entry.length.empty() ? alone_px : card.name_px;
        column_px = std::max(column_px, name_px);
        card.range_px = std::max(card.range_px, setter.width_px(entry.range, look));
        card.length_px = std::max(card.length_px, setter.width_px(entry.length, look));
    }
    const double gap = gap_px * unit;
    const double parts =
        card.name_px + gap + card.range_px + (card.length_px > 0 ? gap * 1.5 + card.length_px : 0);
    card.range_px += std::max(0.0, alone_px - parts);
    const double entry_px = swatch_px * unit + gap + std::max(parts, alone_px);
    const int rows = (int(legend.entries.size()) + columns - 1) / columns;
    const double title = setter.width_px(legend.title, {title_px * unit, true});
    card.width_px = std::ceil(2 * padding_px * unit +
                              std::max(title, columns * entry_px + (columns - 1) * 2 * gap));
    if (!legend.note.empty()) {
        const TextLook small{note_px * unit};
        // A narrow legend grows wider rather than much higher.
        card.width_px = std::max(card.width_px, std::ceil(min_note_width_px * unit));
        card.note = setter.wrapped(
            with_unbroken_numbers(legend.note), small, card.width_px - 2 * padding_px * unit);
    }
    const double note = card.note.empty() ? 0 : double(card.note.size()) * note_row_px + 10;
    card.height_px = std::ceil((2 * padding_px + title_px + 8 + rows * row_px - 6 + note) * unit);
    return card;
}

void draw_legend(DrawTarget& canvas,
                 TypeSetter& setter,
                 const LegendCard& card,
                 const PixelPoint& corner,
                 const Palette& colours) {
    const double unit = card.unit;
    const double padding = padding_px * unit;
    const double line = std::max(1.0, std::round(unit));
    const PixelBox box{corner.x, corner.y, corner.x + card.width_px, corner.y + card.height_px};
    if (card.framed) {
        canvas.fill({box, 6 * unit}, colours.border);
        canvas.fill({{box.left + line, box.top + line, box.right - line, box.bottom - line},
                     6 * unit - line},
                    colours.page);
    }

    const auto write = [&](const std::string& text, const PixelPoint& at, bool bold, auto rgb) {
        canvas.write(setter.mask(text, {(bold ? title_px : text_px) * unit, bold}), at, rgb);
    };
    write(card.legend.title,
          {box.left + padding, std::round(box.top + padding + title_px * 0.78 * unit)},
          true,
          colours.ink);

    const double gap = gap_px * unit;
    const double column_px = (card.width_px - 2 * padding + 2 * gap) / card.columns;
    const double first_px = box.top + padding + (title_px + 8 + row_px / 2 - 3) * unit;
    for (std::size_t i = 0; i < card.legend.entries.size(); ++i) {
        const auto& entry = card.legend.entries[i];
        const auto column = i % std::size_t(card.columns);
        const auto row = i / std::size_t(card.columns);
        const double x = box.left + padding + double(column) * column_px;
        const double y = std::round(first_px + double(row) * row_px * unit);
        const double base = y + std::round(text_px * 0.36 * unit);
        draw_swatch(canvas, entry, {x + swatch_px / 2 * unit, y}, unit, colours);
        const double name_x = x + swatch_px * unit + gap;
        const double range_x = name_x + card.name_px + gap;
        const double length_end = range_x + card.range_px + gap * 1.5 + card.length_px;
        write(entry.name, {name_x, base}, false, colours.ink);
        write(entry.range, {range_x, base}, false, colours.quiet_ink);
        const double length_px = setter.width_px(entry.length, {text_px * unit});
        write(entry.length, {length_end - length_px, base}, false, colours.quiet_ink);
    }
    double base = box.bottom - padding - (double(card.note.size()) - 0.8) * note_row_px * unit;
    for (const auto& text : card.note) {
        canvas.write(setter.mask(text, {note_px * unit}),
                     {box.left + padding, std::round(base)},
                     colours.quiet_ink);
        base += note_row_px * unit;
    }
}
LegendCard widest_card(const Legend& legend, double room_px, double unit, TypeSetter& setter) {
    auto best = legend_card(legend, 1, unit, setter);
    for (int columns = 2; columns <= int(legend.entries.size()); ++columns) {
        const auto card = legend_card(legend, columns, unit, setter);
        if (card.width_px <= room_px && card.height_px < best.height_px) {
            best = card;
        }
    }
    return best;
}

} // namespace macadam
