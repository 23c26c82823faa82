#pragma once

#include "render/report/document/document.hpp"
#include "render/report/document/pdf.hpp"

#include <string>

namespace macadam {

// What render/report/document/pdf.cpp asks of the plug-in macadam_pdf.

using WritePdf = std::string(const Document& document, const PdfConfig& config);
inline constexpr const char* write_pdf_name = "macadam_write_pdf";

} // namespace macadam
