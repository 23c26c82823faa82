#pragma once

#include "render/report/document/document.hpp"
#include "render/report/document/pdf_sheets.hpp"

namespace macadam {

// Blocks of a document, placed on sheets one after another.

inline constexpr double body_size_pt = 9;
inline constexpr double small_size_pt = 8;
inline constexpr double block_gap_pt = 9;

/// Return the height of a block that must stay with its heading: the part before its first page
/// break.
double first_pt(const PdfSheets& sheets, const document::Paragraph& paragraph);
double first_pt(const PdfSheets& sheets, const document::Table& table);
double first_pt(const PdfSheets& sheets, const document::MapFigure& map);

void put(PdfSheets& sheets, const document::Paragraph& paragraph);
void put(PdfSheets& sheets, const document::Bullets& bullets);
void put(PdfSheets& sheets, const document::KeyNumbers& keys);
void put(PdfSheets& sheets, const document::Table& table);
void put(PdfSheets& sheets, const document::Drawing& drawing);
void put(PdfSheets& sheets, const document::Legend& legend);
void put(PdfSheets& sheets, const document::MapFigure& map);
void put(PdfSheets& sheets, const document::Photos& photos);
void put(PdfSheets& sheets, const document::Cards& cards);
void put(PdfSheets& sheets, const document::Overview& overview);

/// Draws a figure with its upper left corner at a position, as wide as given.
void draw_at(
    PdfSheets& sheets, const document::Drawing& drawing, double x_pt, double y_pt, double width_pt);

} // namespace macadam
