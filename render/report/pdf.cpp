#include "render/report/pdf.hpp"

#include "estimator/common/late_library.hpp"
#include "render/late/pdf_writer.hpp"

namespace macadam {

std::string pdf_of(const Document& document, const PdfConfig& config) {
    return late_function<WritePdf>("macadam_pdf.so", write_pdf_name)(document, config);
}

} // namespace macadam
