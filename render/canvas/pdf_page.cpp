#include "render/canvas/pdf_page.hpp"

#include "estimator/common/plugin_library.hpp"

#include <utility>

namespace macadam {

std::string pdf_file(const PdfSheet& sheet, const std::function<void(PdfPage& page)>& draw) {
    std::string file;
    plugin_function<PdfWrite>("macadam_pdf.so", pdf_write_name)(
        sheet, draw, [&](std::string bytes) { file = std::move(bytes); });
    return file;
}

} // namespace macadam
