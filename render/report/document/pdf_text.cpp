#include "render/report/document/pdf_text.hpp"

#include "estimator/common/utf8.hpp"
#include "render/scene/isolated_text.hpp"
#include "render/scene/unbroken_numbers.hpp"
#include "render/text/pdf_families.hpp"

#include <algorithm>
#include <string_view>

namespace macadam {

using namespace document;

namespace {

constexpr float line_spacing = 1.12F; // relative to the font's own, which is 1.36 for Noto Sans

struct FreeFont {
    void operator()(PangoFontDescription* font) const { pango_font_description_free(font); }
};
struct FreeAttributes {
    void operator()(PangoAttrList* list) const { pango_attr_list_unref(list); }
};

/// Returns valid UTF-8 without control characters except line breaks, nor ones of direction except
/// isolates of names.
std::string cleaned(const std::string& text) {
    char* const valid = g_utf8_make_valid(text.data(), static_cast<gssize>(text.size()));
    const std::string all{valid};
    g_free(valid);
    std::string clean;
    for (std::string_view rest{all}; !rest.empty();) {
        const auto letter = rest.substr(0, std::max<std::size_t>(1, utf8_length(rest)));
        const auto first = static_cast<unsigned char>(letter.front());
        if (first != '\n' && (first < 0x20 || first == 0x7F)) {
            clean += ' ';
        } else if (const auto code = utf8_letter(letter);
                   code == isolate_begin || code == isolate_end || !is_bidi_control(code)) {
            clean += letter;
        }
        rest.remove_prefix(letter.size());
    }
    return clean;
}

guint16 channel(std::uint32_t rgb, int shift) {
    return static_cast<guint16>((rgb >> shift & 0xFFU) * 257);
}

void insert(PangoAttrList* list, PangoAttribute* attribute, std::size_t from, std::size_t to) {
    attribute->start_index = static_cast<guint>(from);
    attribute->end_index = static_cast<guint>(to);
    pango_attr_list_insert(list, attribute);
}

void add_look(PangoAttrList* list, const Span& span, std::size_t from, std::size_t to) {
    if (span.look == SpanLook::strong) {
        insert(list, pango_attr_weight_new(PANGO_WEIGHT_BOLD), from, to);
    }
    if (span.look == SpanLook::quiet) {
        insert(list,
               pango_attr_foreground_new(
                   channel(print::quiet, 16), channel(print::quiet, 8), channel(print::quiet, 0)),
               from,
               to);
    }
    if (span.unbroken) {
        insert(list, pango_attr_allow_breaks_new(FALSE), from, to);
    }
}

/// Lets no line end within a unit.
void keep_units_whole(PangoAttrList* list, std::string_view text) {
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (const auto length = slashed_unit_at_start(text.substr(at)); length > 0) {
            insert(list, pango_attr_allow_breaks_new(FALSE), at, at + length);
        }
    }
}

} // namespace

PdfText::PdfText(cairo_t* cairo, const RichText& rich, const PdfType& type, double width_pt)
    : layout_{pango_cairo_create_layout(cairo)}, rgb_{type.rgb} {
    auto* const context = pango_layout_get_context(layout_.get());
    pango_cairo_context_set_resolution(context, 72); // one unit of the page is a point
    pango_context_set_round_glyph_positions(context, FALSE);
    // A text that begins with an Arabic name still runs from left to right, as on pages.
    pango_context_set_base_dir(context, PANGO_DIRECTION_LTR);
    pango_layout_set_auto_dir(layout_.get(), FALSE);
    const std::unique_ptr<PangoFontDescription, FreeFont> font{pango_font_description_new()};
    pango_font_description_set_size(font.get(), pango_units_from_double(type.size_pt));
    pango_font_description_set_weight(font.get(),
                                      type.bold ? PANGO_WEIGHT_BOLD : PANGO_WEIGHT_NORMAL);

    std::string text;
    const std::unique_ptr<PangoAttrList, FreeAttributes> looks{pango_attr_list_new()};
    for (const auto& span : rich.spans) {
        if (span.look == SpanLook::phone) {
            continue; // paper has room for the columns with this content
        }
        const auto from = text.size();
        text += cleaned(with_unbroken_numbers(span.text));
        add_look(looks.get(), span, from, text.size());
        target_ = span.target.empty() ? target_ : span.target;
        address_ = span.address.empty() ? address_ : span.address;
    }
    keep_units_whole(looks.get(), text);
    pango_font_description_set_family(font.get(), pdf_families_for(text).c_str());
    pango_layout_set_font_description(layout_.get(), font.get());
    insert(looks.get(), pango_attr_font_features_new("tnum=1"), 0, text.size());
    pango_layout_set_text(layout_.get(), text.data(), static_cast<int>(text.size()));
    pango_layout_set_attributes(layout_.get(), looks.get());
    pango_layout_set_wrap(layout_.get(),
                          type.breaks_words ? PANGO_WRAP_WORD_CHAR : PANGO_WRAP_WORD);
    pango_layout_set_alignment(layout_.get(),
                               type.to_the_right ? PANGO_ALIGN_RIGHT : PANGO_ALIGN_LEFT);
    pango_layout_set_line_spacing(layout_.get(), line_spacing);
    pango_layout_set_width(layout_.get(), width_pt < 0 ? -1 : pango_units_from_double(width_pt));
}

double PdfText::width_pt() const {
    int width = 0;
    pango_layout_get_size(layout_.get(), &width, nullptr);
    return pango_units_to_double(width);
}

double PdfText::height_pt() const {
    int height = 0;
    pango_layout_get_size(layout_.get(), nullptr, &height);
    return pango_units_to_double(height);
}

std::string PdfText::in_order_of_reading() const {
    return without_direction_controls(pango_layout_get_text(layout_.get()));
}

bool PdfText::is_reordered() const {
    const std::unique_ptr<PangoLayoutIter, decltype(&pango_layout_iter_free)> runs{
        pango_layout_get_iter(layout_.get()), pango_layout_iter_free};
    do {
        const auto* const run = pango_layout_iter_get_run_readonly(runs.get());
        if (run != nullptr && run->item->analysis.level != 0) {
            return true;
        }
    } while (pango_layout_iter_next_run(runs.get()) != FALSE);
    return false;
}

} // namespace macadam
