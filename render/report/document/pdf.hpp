#pragma once

#include "render/report/document/document.hpp"

#include <string>

namespace macadam {

/// Upright sheet, in points of 1/72 inch.
struct Paper {
    double width_pt;
    double height_pt;
};
inline constexpr Paper a4{595.276, 841.890}; ///< ISO 216: 210 x 297 mm
inline constexpr Paper us_letter{612, 792};  ///< 8.5 x 11 inches

struct PdfConfig {
    Paper paper = a4;
};

/// Returns the document as the bytes of a PDF file: A4 or letter, running head and page numbers,
/// table headings repeated on every page, vector figures, an outline, links, embedded fonts. Its
/// dates are those of the data: the same document and the same fonts give the same bytes.
///
/// Cairo and Pango are loaded on the first call.
///
/// \throws InputError  if they cannot be opened or report an error.
std::string pdf_of(const Document& document, const PdfConfig& config);

} // namespace macadam
