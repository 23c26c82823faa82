#include "render/report/strip_chart.hpp"

#include "estimator/common/utf8.hpp"
#include "render/report/common_parts.hpp"
#include "render/report/sections.hpp"
#include "render/scene/nice_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

namespace macadam {

using namespace document;

namespace {

constexpr double left = 34;
constexpr double right_margin = 8;
constexpr double letter = 6.2; // approximate width of a letter of 12 units
constexpr double line = 15;    // height of a line of text
constexpr double row_gap = 12;
constexpr double m_per_ft = 0.3048;

/// Returns the approximate width of a text.
double width_of(std::string_view text) {
    std::size_t letters = 0;
    for (; !text.empty(); ++letters) {
        text.remove_prefix(std::max<std::size_t>(1, utf8_length(text)));
    }
    return letter * static_cast<double>(letters);
}

double length_m(const Strip& strip) {
    return std::max(strip.to_m - strip.from_m, 1.0);
}

/// Scales of a chart. A row's columns stand on its bottom.
struct Scales {
    const Strip& strip;
    double width;
    double max_iri; ///< mm/m, at the top of a row
    double row_height;

    double x(double at_m) const {
        return left + (width - right_margin - left) * (at_m - strip.from_m) / length_m(strip);
    }
    double height(double iri) const { return row_height * std::min(iri / max_iri, 1.0); }
};

/// Returns the end of the axis: all values, and of their intervals what is not far beyond them.
double highest(const Strip& strip, double border) {
    double value = border, interval = border;
    for (const auto& row : strip.rows) {
        for (const auto& piece : row.pieces) {
            value = std::max(value, piece.iri);
            interval = std::max(interval, piece.high);
        }
    }
    constexpr double most_above_values = 1.4;
    return std::min(interval, most_above_values * value);
}

std::string words_of(const Report& report, const StripPiece& piece) {
    const auto& say = report.wording;
    return say("strip.value",
               {{"from", say.short_length(piece.from_m)},
                {"to", say.short_length(piece.to_m)},
                {"iri", say.iri(piece.iri)},
                {"interval", say.interval(piece.low, piece.high)}});
}

void add_axis(Drawing& drawing, const Report& report, const Scales& scales, double bottom) {
    const auto& say = report.wording;
    const double per_mm_per_m = in_unit(1, say.unit);
    const double step = nice_step(scales.max_iri * per_mm_per_m, 3) / per_mm_per_m;
    for (double iri = 0; iri < scales.max_iri * (1 + 1e-9); iri += step) {
        const double y = bottom - scales.height(iri);
        drawing.shapes.emplace_back(
            Stroke{StrokeLook::grid, {{left, y}, {scales.width - right_margin, y}}});
        drawing.shapes.emplace_back(
            Label{left - 5, y + 4, Anchor::end, say.shortest(iri * per_mm_per_m)});
    }
}

void add_pieces(Drawing& drawing,
                const Report& report,
                const Scales& scales,
                const StripRow& row,
                double bottom) {
    for (const auto& piece : row.pieces) {
        const double x = scales.x(piece.from_m);
        const double width = std::max(scales.x(piece.to_m) - x, 0.4);
        const double gap = width > 3 ? 0.4 : 0;
        Bar column{x, bottom - scales.height(piece.iri), width - gap, scales.height(piece.iri), 0};
        column.rgb = report.colours[std::min(piece.iri_class, report.colours.size() - 1)];
        column.edged = false;
        column.words = words_of(report, piece);
        drawing.shapes.emplace_back(std::move(column));
        const double top = scales.height(piece.high);
        drawing.shapes.emplace_back(Band{
            x, bottom - top, width - gap, top - scales.height(piece.low), words_of(report, piece)});
    }
    const double border = bottom - scales.height(report.poor_above_mm_per_m);
    drawing.shapes.emplace_back(
        Stroke{StrokeLook::mean, {{left, border}, {scales.width - right_margin, border}}});
}

/// Adds names where they do not overlap the one before.
void add_marks(Drawing& drawing, const Scales& scales, double names_y, double top, double bottom) {
    double free_from = left;
    for (const auto& [at_m, name] : scales.strip.marks) {
        const double x = scales.x(at_m);
        drawing.shapes.emplace_back(Stroke{StrokeLook::grid, {{x, top}, {x, bottom}}});
        const double half = width_of(name) / 2;
        if (x - half >= free_from && x + half <= scales.width) {
            drawing.shapes.emplace_back(Label{x, names_y, Anchor::middle, name});
            free_from = x + half + letter;
        }
    }
}

void add_chainage(Drawing& drawing, const Report& report, const Scales& scales, double y) {
    const auto& say = report.wording;
    const double unit_m = say.unit == IriUnit::in_per_mi ? m_per_ft : 1;
    const auto& strip = scales.strip;
    const double step_m = nice_step(length_m(strip) / unit_m, scales.width > 500 ? 10 : 4) * unit_m;
    const auto end = say("strip.axis");
    const double last_x = scales.width - right_margin - width_of(end);
    for (double at_m = std::max(0.0, std::ceil(strip.from_m / step_m - 1e-9) * step_m);
         at_m <= strip.to_m && scales.x(at_m) < last_x - 2 * letter;
         at_m += step_m) {
        drawing.shapes.emplace_back(
            Label{scales.x(at_m), y, Anchor::middle, say.short_length(at_m)});
    }
    drawing.shapes.emplace_back(Label{scales.width - right_margin, y, Anchor::end, end});
}

/// Adds control and reference sections as lines with their names.
void add_spans(Drawing& drawing, const Scales& scales, double y) {
    for (const auto& [from_m, to_m, name] : scales.strip.spans) {
        const double from = scales.x(std::max(from_m, scales.strip.from_m));
        const double to = scales.x(std::min(to_m, scales.strip.to_m));
        drawing.shapes.emplace_back(Band{from, y - 10, std::max(to - from, 1.0), 4, name});
        drawing.shapes.emplace_back(Label{from, y + 6, Anchor::start, name});
        y += line;
    }
}

} // namespace

Drawing
strip_drawing(const Report& report, const Strip& strip, StripSize size, const std::string& words) {
    const auto& say = report.wording;
    const double most = highest(strip, report.poor_above_mm_per_m);
    const double per_mm_per_m = in_unit(1, say.unit);
    const double step = nice_step(most * per_mm_per_m, 3) / per_mm_per_m;
    const Scales scales{strip,
                        size.width,
                        step * std::max(1.0, std::ceil(most / step - 1e-9)),
                        size.row_height - line - row_gap};
    Drawing drawing{size.width, 0, words, {}};
    const double names = strip.marks.empty() ? 0 : line;
    double y = names;
    for (const auto& row : strip.rows) {
        const double bottom = y + line + scales.row_height;
        drawing.shapes.emplace_back(Label{left, y + 11, Anchor::start, row.title});
        add_axis(drawing, report, scales, bottom);
        add_pieces(drawing, report, scales, row, bottom);
        y = bottom + row_gap;
    }
    add_marks(drawing, scales, 11, names + line, y - row_gap);
    y += 4;
    add_chainage(drawing, report, scales, y);
    y += line;
    add_spans(drawing, scales, y);
    drawing.height = y + line * static_cast<double>(strip.spans.size()) - 8;
    return drawing;
}

namespace {

constexpr std::size_t directions = 2;

/// Segments of both directions by their place along the chainage.
using PiecesByPlace =
    std::map<std::pair<double, double>, std::array<const StripPiece*, directions>>;

/// Builds a table of all segments, both directions side by side; no rows where none is measured.
Table table_of(const Report& report) {
    const auto& say = report.wording;
    Table table{say("strip.caption", {{"unit", std::string{say.iri_unit()}}}),
                {{say("column.from_m"), true}, {say("column.to_m"), true}},
                {}};
    std::size_t shown = 0;
    PiecesByPlace places;
    for (const auto& strip : report.strips) {
        shown = std::max(shown, std::min(strip.rows.size(), directions));
        for (std::size_t row = 0; row < std::min(strip.rows.size(), directions); ++row) {
            for (const auto& piece : strip.rows[row].pieces) {
                places[{piece.from_m, piece.to_m}][row] = &piece;
            }
        }
    }
    for (std::size_t row = 0; row < shown; ++row) {
        const auto title = report.strips.front().rows.size() > row && shown > 1
                               ? report.strips.front().rows[row].title + ": "
                               : std::string{};
        table.columns.push_back({title + "IRI", true});
        table.columns.push_back({say("column.interval"), true});
        table.columns.push_back({say("column.class")});
    }
    for (const auto& [place, pieces] : places) {
        std::vector<Cell> cells{say.short_length(place.first), say.short_length(place.second)};
        for (std::size_t row = 0; row < shown; ++row) {
            const auto* const piece = pieces[row];
            cells.emplace_back(piece != nullptr ? say.iri(piece->iri) : "–");
            cells.emplace_back(piece != nullptr ? say.interval(piece->low, piece->high) : "");
            cells.emplace_back(piece != nullptr ? class_name(report, piece->iri_class) : "");
        }
        table.rows.push_back(std::move(cells));
    }
    return table;
}

} // namespace

DocumentSection strip_section(const Report& report) {
    const auto& say = report.wording;
    DocumentSection section{say("strip"), {}};
    auto table = table_of(report);
    if (table.rows.empty()) {
        section.blocks.emplace_back(Paragraph{say("strip.none")});
        return section;
    }
    section.blocks.emplace_back(
        Paragraph{say("strip.about", {{"unit", std::string{say.iri_unit()}}})});
    for (const auto& strip : report.strips) {
        const auto road = fmt::format("{}–{} {}",
                                      say.short_length(strip.from_m),
                                      say.short_length(strip.to_m),
                                      say("unit.short"));
        section.blocks.emplace_back(
            strip_drawing(report, strip, strip_on_page, say("strip.words", {{"road", road}})));
        Photos photos;
        for (const auto& photo : strip.photos) {
            photos.photos.push_back(photo_of(report, photo, road));
            photos.photos.back().caption = say(
                "strip.photo",
                {{"at", say.short_length(photo.at_m)}, {"photo", photos.photos.back().caption}});
        }
        if (!photos.photos.empty()) {
            section.blocks.emplace_back(std::move(photos));
        }
    }
    section.blocks.emplace_back(std::move(table));
    return section;
}

} // namespace macadam
