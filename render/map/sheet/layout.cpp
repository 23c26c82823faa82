#include "render/map/sheet/layout.hpp"

#include "render/scene/unbroken_numbers.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

// Sizes at 1000 px.
constexpr double title_px = 30;
constexpr double subtitle_px = 17;
constexpr double attribution_px = 13;
constexpr double margin_px = 26;
constexpr double scale_room_px = 300;
constexpr double scale_height_px = 50;
constexpr double line_height = 1.3; // of the em
constexpr double ascent = 0.93;     // of capitals with accents in Noto Sans, in units of the em
constexpr double max_header = 0.3;  // of the sheet's height

constexpr double units_per_inch = 96;
constexpr double usual_side = 1000; // of a sheet whose unit is 1: 265 mm, between A4 and A3

struct Block {
    std::vector<std::string> lines;
    TextLook look;
    double height_px() const { return double(lines.size()) * look.size_px * line_height; }
};

/// Sets a block of text. Text too long for two lines is set smaller, then in more lines; only text
/// that would take the map's own area is omitted, with an indication.
Block block(
    TypeSetter& setter, const std::string& words, TextLook look, double width, double height) {
    const auto text = with_unbroken_numbers(words);
    const double smallest_px = look.size_px * 0.7;
    auto lines = setter.wrapped(text, look, width);
    while (lines.size() > 1 && look.size_px * 0.92 >= smallest_px) {
        look.size_px *= 0.92;
        lines = setter.wrapped(text, look, width);
    }
    const auto most = std::max<std::size_t>(1, std::size_t(height / (look.size_px * line_height)));
    if (lines.size() > most) {
        lines.resize(most);
        lines.back() = setter.wrapped(lines.back(), look, width - look.size_px).front() + "…";
    }
    return {lines, look};
}

std::vector<PositionedText> placed(const Block& block, const PixelPoint& corner, bool quiet) {
    std::vector<PositionedText> texts;
    texts.reserve(block.lines.size());
    double y = corner.y + block.look.size_px * ascent;
    for (const auto& line : block.lines) {
        texts.push_back({line, block.look, {corner.x, std::round(y)}, quiet});
        y += block.look.size_px * line_height;
    }
    return texts;
}

} // namespace

double paper_unit_of(const PictureSize& size) {
    return size.px_per_inch > 0 ? size.px_per_inch / units_per_inch : unit_of(size);
}

double unit_of(const PictureSize& size) {
    const double px = size.px_per_inch > 0 ? size.px_per_inch / units_per_inch : 1;
    const double side = std::min(size.width_px, size.height_px) / px / usual_side;
    if (size.px_per_inch > 0 && side > 1) {
        return px * std::sqrt(side);
    }
    return px * std::max(side, std::clamp(side * usual_side / 512 * 0.72, 0.55, 0.72));
}

PixelBox inset(const PixelBox& box, double margin) {
    return {box.left + margin, box.top + margin, box.right - margin, box.bottom - margin};
}

Layout layout_of(const MapScene& scene, const PictureSize& size, TypeSetter& setter) {
    const auto width_px = size.width_px;
    const auto height_px = size.height_px;
    const double unit = unit_of(size);
    const double margin = std::round(margin_px * unit);
    const double width = width_px - 2 * margin;
    const double max_px = height_px * max_header;
    Layout layout;
    layout.unit = unit;
    layout.paper_unit = paper_unit_of(size);
    layout.width_px = width_px;
    const auto add = [&layout](const std::vector<PositionedText>& texts) {
        layout.texts.insert(layout.texts.end(), texts.begin(), texts.end());
    };

    const auto title = block(setter, scene.title, {title_px * unit, true}, width, max_px * 0.6);
    const auto subtitle = block(setter, scene.subtitle, {subtitle_px * unit}, width, max_px * 0.4);
    double top = 0;
    if (title.height_px() + subtitle.height_px() > 0) {
        top = margin * 0.7;
        add(placed(title, {margin, top}, false));
        top += title.height_px();
        add(placed(subtitle, {margin, top}, true));
        top += subtitle.height_px() + margin * 0.6;
    }

    const double scale_width = std::min(scale_room_px * unit, width * 0.45);
    const TextLook small{attribution_px * unit};
    const auto credit =
        block(setter, scene.attribution, small, width - scale_width - margin, max_px * 0.5);
    const double scale_height = scene.scale_bar ? scale_height_px * unit : 0;
    const double credit_height = credit.lines.empty() ? 0 : credit.height_px() + margin * 0.8;
    const double footer = std::max(credit_height, scale_height);
    const double bottom = std::round(height_px - footer);
    double y = bottom + (footer - credit.height_px()) / 2;
    for (const auto& line : credit.lines) {
        const double line_width = setter.width_px(line, credit.look);
        add(placed({{line}, credit.look}, {width_px - margin - line_width, y}, true));
        y += credit.look.size_px * line_height;
    }
    layout.whole_map = {0, std::round(top), double(width_px), bottom};
    layout.map = layout.whole_map;
    layout.scale_bar = scene.scale_bar;
    layout.is_on_paper = size.is_on_paper;
    layout.edges = !scene.to_the_edge;
    layout.scale_room = {margin, bottom, margin + scale_width, double(height_px)};
    return layout;
}

} // namespace macadam
