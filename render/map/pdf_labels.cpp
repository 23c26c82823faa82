#include "render/map/pdf_labels.hpp"

namespace macadam {
namespace {

TurnedText turned_text(const Label& label, const LabelInks& inks, const TypeSetter& setter) {
    TurnedText text{.standing = TypeSetter::as_it_stands(label.name),
                    .size_px = label.look.size_px,
                    .glyphs = {},
                    .rgb = label.quiet ? inks.quiet_ink : inks.ink,
                    .halo_px = label.halo_px,
                    .halo_rgb = inks.halo};
    text.glyphs.reserve(label.glyphs.size());
    for (const auto& [glyph, pose] : label.glyphs) {
        text.glyphs.push_back(
            {setter.source(glyph.font),
             glyph.index,
             {pose.x_px + label.left, pose.y_px + label.top, pose.along_x, pose.along_y}});
    }
    return text;
}

} // namespace

void draw_labels(PdfPage& page,
                 std::span<const Label> labels,
                 const LabelInks& inks,
                 const TypeSetter& setter) {
    for (const auto& label : labels) {
        if (label.is_shield) {
            draw_shield(page, label.box, inks);
        }
        page.write_turned(turned_text(label, inks, setter));
    }
}

} // namespace macadam
