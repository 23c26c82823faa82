#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace macadam {

/// Parses a text that is entirely one number in the type's range; `std::nullopt` otherwise, also
/// for blanks around it and for a plus sign.
///
/// \param format  base of an integer, or std::chars_format
template <typename Number, typename... Format>
std::optional<Number> exact_number(std::string_view text, Format... format) {
    Number number{};
    const auto* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number, format...);
    return error == std::errc{} && stop == end ? std::optional{number} : std::nullopt;
}

} // namespace macadam
