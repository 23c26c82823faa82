#include "storage/text/text.hpp"

#include "estimator/common/utf8.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace macadam {

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) {
        return {};
    }
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string in_quotes(std::string_view text, std::size_t longest) {
    std::string result = "'";
    for (auto rest = text.substr(0, longest); !rest.empty();) {
        const auto letter = rest.substr(0, std::max<std::size_t>(1, utf8_length(rest)));
        const auto code = utf8_letter(letter);
        if ((code >= 0x20 && code <= 0x7e) || (letter.size() > 1 && code >= 0xa0)) {
            result += letter;
        } else {
            for (const char c : letter) {
                result += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
            }
        }
        rest.remove_prefix(letter.size());
    }
    return result + (text.size() > longest ? "...'" : "'");
}

std::optional<double> parse_number(std::string_view text) {
    text = trimmed(text);
    if (text.starts_with('+') && !text.starts_with("+-")) {
        text.remove_prefix(1);
    }
    double number = 0;
    const auto* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc{} || stop != end || std::isinf(number)) {
        return {};
    }
    return number;
}

} // namespace macadam
