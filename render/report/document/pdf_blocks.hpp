#pragma once

#include "render/report/document/document.hpp"
#include "render/report/document/pdf_sheets.hpp"

namespace macadam {

// Parts of a document, put on sheets where the last one ended.

inline constexpr double body_size_pt = 9;
inline constexpr double small_size_pt = 8;
inline constexpr double block_gap_pt = 9;

/// How much of a block must stand under its heading: all that does not go over a page.
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
void put(PdfSheets& sheets, const document::Cards& cards);

} // namespace macadam
