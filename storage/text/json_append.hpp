#pragma once

#include "storage/text/columns.hpp"

#include <string>
#include <string_view>

namespace macadam {

/// Appends a number with a fixed count of decimals, correctly rounded as by printf: for texts of
/// many numbers, in a fifth of the time of fmt.
void append_fixed(std::string& text, double value, int decimals);

/// Appends json_text(value) (json.hpp).
void append_json_text(std::string& text, std::string_view value);

/// Appends a cell as JsonObject::add() writes its json_value().
void append_json(std::string& text, const ColumnType& type, const Cell& cell);

} // namespace macadam
