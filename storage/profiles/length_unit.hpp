#pragma once

#include <optional>
#include <string_view>

namespace macadam {

/// Metres per unit of length, for the abbreviations of profile files (m, mm, in, ft, mil, ...) in
/// any case, including words truncated to 8 characters. Returns `std::nullopt` for any other unit.
std::optional<double> metres_in(std::string_view unit);

} // namespace macadam
