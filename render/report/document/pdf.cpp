#include "render/report/document/pdf.hpp"

#include "estimator/common/plugin_library.hpp"
#include "render/report/document/report_pdf_plugin.hpp"

namespace macadam {

std::string pdf_of(const Document& document, const PdfConfig& config) {
    return plugin_function<WritePdf>("macadam_pdf.so", write_pdf_name)(document, config);
}

} // namespace macadam
