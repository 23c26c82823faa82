#pragma once

#include <concepts>
#include <optional>
#include <ranges>
#include <string>
#include <string_view>

namespace macadam {

/// Appends a text to an open array of PostgreSQL, quoted; `std::nullopt` is NULL.
void append_array_text(std::string& array, const std::optional<std::string_view>& text);

/// Array of PostgreSQL, as the value of a parameter.
template <std::ranges::input_range Numbers>
requires std::integral<std::ranges::range_value_t<Numbers>> std::string
array_of(const Numbers& numbers) {
    std::string array(1, '{');
    for (const auto number : numbers) {
        if (array.size() > 1) {
            array.push_back(',');
        }
        array += std::to_string(number);
    }
    array.push_back('}');
    return array;
}

template <std::ranges::input_range Texts>
requires std::convertible_to<std::ranges::range_reference_t<Texts>, std::optional<std::string_view>>
    std::string array_of(const Texts& texts) {
    std::string array(1, '{');
    for (const auto& text : texts) {
        append_array_text(array, text);
    }
    array.push_back('}');
    return array;
}

} // namespace macadam
