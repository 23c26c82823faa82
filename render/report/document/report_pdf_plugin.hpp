#pragma once

#include "render/report/document/document.hpp"
#include "render/report/document/pdf.hpp"

#include <string>

namespace macadam {

// Entry point of the plug-in macadam_pdf for render/report/document/pdf.cpp.

using WritePdf = std::string(const Document& document, const PdfConfig& config);
inline constexpr const char* write_pdf_name = "macadam_write_pdf";

} // namespace macadam
