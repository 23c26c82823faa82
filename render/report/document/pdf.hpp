#pragma once

#include "render/report/document/document.hpp"

#include <string>

namespace macadam {

/// A sheet, upright, in points of 1/72 inch.
struct Paper {
    double width_pt;
    double height_pt;
};
inline constexpr Paper a4{595.276, 841.890}; ///< ISO 216: 210 x 297 mm
inline constexpr Paper us_letter{612, 792};  ///< 8.5 x 11 inches

struct PdfConfig {
    Paper paper = a4;
};

/// The document as the bytes of a PDF file: A4 or letter, running head and page numbers, heads of
/// tables on every page that they reach, figures as vectors, an outline, links, fonts embedded.
/// What dates it has are those of the data: the same document and the same fonts give the same
/// bytes.
///
/// Cairo and Pango do the work; they are opened when this is first called.
///
/// \throws InputError  if they cannot be opened or report an error.
std::string pdf_of(const Document& document, const PdfConfig& config);

} // namespace macadam
