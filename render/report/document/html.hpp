#pragma once

#include "render/report/document/document.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace macadam {

/// Text as it may stand in an element or in a quoted attribute. Control characters become blanks,
/// bytes that are not UTF-8 the replacement character.
std::string escaped(std::string_view text);

/// RFC 4648, with padding.
std::string base64(std::span<const std::uint8_t> bytes);

/// With caption and scopes, in a box of its own that scrolls where the page is too narrow.
/// \param cell_html  what stands in a cell
std::string table_html(const document::Table& table,
                       const std::function<std::string(const document::Cell&)>& cell_html);

} // namespace macadam
