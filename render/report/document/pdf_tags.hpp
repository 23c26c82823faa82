#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace macadam {

/// Structure of a PDF that Cairo 1.16 cannot write. Lists are in the order of the elements.
struct PdfAccess {
    std::string language;
    std::string title;
    std::vector<std::string> figures;       ///< alternative texts
    std::vector<std::string> heading_scope; ///< of TH: "Column" or "Row"
    std::size_t elements = 0;               ///< of all kinds

    /// Texts of elements with letters that run from right to left, which the page has in the order
    /// of their positions. The key is the number of elements that begin before it.
    std::map<std::size_t, std::string> spoken;
};

/// Returns a tagged PDF of Cairo as one that conforms to PDF/UA-1 (ISO 14289-1) as far as a program
/// can tell: language and title, alternative texts, scopes of table headings, descriptions of
/// links, texts in the order of reading, and whatever lies outside the structure marked as an
/// artifact. The same bytes give the same bytes. \throws InputError  if it is no PDF, or has other
/// elements than the lists.
std::string accessible_pdf(const std::string& pdf, const PdfAccess& access);

} // namespace macadam
