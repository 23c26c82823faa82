#pragma once

#include <string>
#include <string_view>

namespace macadam {

/// Escapes text for elements and quoted attributes of XML 1.0. Characters that XML cannot represent
/// (control characters, bytes that are not UTF-8) become U+FFFD.
std::string xml_text(std::string_view text);

} // namespace macadam
