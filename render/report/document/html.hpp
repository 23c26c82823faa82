#pragma once

#include "render/report/document/document.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace macadam {

/// Escapes text for use in an element or in a quoted attribute. Control characters become blanks,
/// bytes that are not UTF-8 become the replacement character, and controls of direction go.
std::string escaped(std::string_view text);

/// Escapes text of an element. Lines break within words only if these are longer than a column, and
/// never between numbers and their units; '\n' becomes a break, isolated names remain so.
std::string breakable(std::string_view of);

/// Encodes bytes by RFC 4648, with padding.
std::string base64(std::span<const std::uint8_t> bytes);

/// Returns a table with caption and scopes, in a box that scrolls if the page is too narrow.
/// \param cell_html  converts the content of a cell
std::string table_html(const document::Table& table,
                       const std::function<std::string(const document::Cell&)>& cell_html);

} // namespace macadam
