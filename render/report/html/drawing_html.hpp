#pragma once

#include "render/report/document/document.hpp"

#include <string>

namespace macadam::document {

/// Returns a drawing as inline SVG; a wide one in a region that scrolls.
std::string block_html(const Drawing& drawing);

} // namespace macadam::document
