#pragma once

#include "render/report/document.hpp"
#include "render/report/pdf.hpp"

#include <string>

namespace macadam {

// What render/report/pdf.cpp asks of the late library macadam_pdf.

using WritePdf = std::string(const Document& document, const PdfConfig& config);
inline constexpr const char* write_pdf_name = "macadam_write_pdf";

} // namespace macadam
