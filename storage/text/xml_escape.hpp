#pragma once

#include <string>
#include <string_view>

namespace macadam {

/// Text as XML 1.0 holds it in elements and in quoted attributes. What it cannot say in any way
/// (control characters, bytes that are not UTF-8) becomes U+FFFD.
std::string xml_text(std::string_view text);

} // namespace macadam
