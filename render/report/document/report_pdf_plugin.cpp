#include "render/report/document/report_pdf_plugin.hpp"

#include "render/report/document/pdf_blocks.hpp"

#include <algorithm>
#include <ranges>
#include <variant>

namespace macadam {

using namespace document;

namespace {

constexpr double title_size_pt = 20;
constexpr double heading_size_pt = 13;
constexpr double lead_size_pt = 13;

/// Adds the sentence that says what matters, larger than the text.
void put_lead(PdfSheets& sheets, const RichText& lead) {
    const auto text = sheets.text(lead, {.size_pt = lead_size_pt, .bold = true}, sheets.width_pt());
    const PdfElement element{sheets, "P"};
    sheets.draw(text, sheets.left_pt(), sheets.y_pt());
    sheets.skip(text.height_pt() + block_gap_pt);
}

void put_title(PdfSheets& sheets, const Document& document) {
    const auto title =
        sheets.text(document.title, {.size_pt = title_size_pt, .bold = true}, sheets.width_pt());
    {
        const PdfElement element{sheets, "H1"};
        sheets.draw(title, sheets.left_pt(), sheets.y_pt());
    }
    sheets.skip(title.height_pt() + 3);
    const auto subtitle = sheets.text(
        document.subtitle, {.size_pt = body_size_pt, .rgb = print::quiet}, sheets.width_pt());
    {
        const PdfElement element{sheets, "P"};
        sheets.draw(subtitle, sheets.left_pt(), sheets.y_pt());
    }
    sheets.skip(subtitle.height_pt() + block_gap_pt);
    if (!document.lead.spans.empty()) {
        put_lead(sheets, document.lead);
    }
    if (!document.keys.numbers.empty()) {
        put(sheets, document.keys);
    }
    if (document.overview) {
        put(sheets, *document.overview);
    }
}

/// Returns the height that must follow a heading, so that it is not left alone at the end of a
/// page.
double room_under_heading(const PdfSheets& sheets, const DocumentSection& section) {
    constexpr double of_others_pt = 40;
    double room_pt = 0;
    for (const auto& block : section.blocks | std::views::take(2)) {
        if (const auto* const paragraph = std::get_if<Paragraph>(&block)) {
            return first_pt(sheets, *paragraph);
        }
        if (const auto* const table = std::get_if<Table>(&block)) {
            return first_pt(sheets, *table);
        }
        const auto* const map = std::get_if<MapFigure>(&block); // follows its legend
        room_pt += map != nullptr ? first_pt(sheets, *map) : of_others_pt;
    }
    return room_pt;
}

/// Adds cards as entries under their section's.
void outline_cards(const PdfSheets& sheets, const Cards& cards, int above) {
    for (const auto& card : cards.cards) {
        sheets.outline_to(card.id, card.title, above);
    }
}

void put_section(PdfSheets& sheets, const DocumentSection& section) {
    const auto heading =
        sheets.text(section.title, {.size_pt = heading_size_pt, .bold = true}, sheets.width_pt());
    const double gap_pt = sheets.is_at_top() ? 0 : 8;
    sheets.need(std::min(sheets.height_pt(),
                         gap_pt + heading.height_pt() + 4 + room_under_heading(sheets, section)));
    sheets.skip(sheets.is_at_top() ? 0 : gap_pt);
    const int entry = sheets.outline(section.title, CAIRO_PDF_OUTLINE_ROOT);
    {
        const PdfElement element{sheets, "H2"};
        sheets.draw(heading, sheets.left_pt(), sheets.y_pt());
    }
    sheets.skip(heading.height_pt() + 4);
    for (const auto& block : section.blocks) {
        if (const auto* const cards = std::get_if<Cards>(&block)) {
            outline_cards(sheets, *cards, entry);
        }
        std::visit([&](const auto& of) { put(sheets, of); }, block);
    }
}

void put_all(PdfSheets& sheets, const Document& document) {
    const PdfElement element{sheets, "Document"};
    put_title(sheets, document);
    for (const auto& section : document.sections) {
        put_section(sheets, section);
    }
    for (const auto& section : document.end) {
        put_section(sheets, section);
    }
}

} // namespace
} // namespace macadam

// The layout runs twice, since the number of pages is known only after the first run.
extern "C" std::string macadam_write_pdf(const macadam::Document& document,
                                         const macadam::PdfConfig& config) {
    macadam::PdfSheets counted{document, config, std::nullopt};
    macadam::put_all(counted, document);
    macadam::PdfSheets sheets{document, config, counted.count()};
    macadam::put_all(sheets, document);
    return sheets.finished();
}
