#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Text as it may stand in an element or in a quoted attribute. Control characters become blanks,
/// bytes that are not UTF-8 the replacement character.
std::string escaped(std::string_view text);

/// RFC 4648, with padding.
std::string base64(std::span<const std::uint8_t> bytes);

struct HtmlColumn {
    std::string title;      ///< HTML
    bool number = false;    ///< aligned to the right
    bool elsewhere = false; ///< left out on phones: the page says it in another place, too
};

/// A table whose first column names its rows. Cells are HTML, as many in a row as columns.
struct HtmlTable {
    std::string caption; ///< text
    std::vector<HtmlColumn> columns;
    std::vector<std::vector<std::string>> rows;
    bool sum = false;    ///< the last row is of all others together
    bool stacks = false; ///< where columns have no room each row is a block of titles and values
};

/// With caption and scopes, in a box of its own that scrolls where the page is too narrow.
std::string html_of(const HtmlTable& table);

} // namespace macadam
