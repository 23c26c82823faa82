#include "app/serve/filters/cql2_like.hpp"

#include <cstddef>

namespace macadam {
namespace {

/// Bytes of the letter at the beginning of a text that is not empty.
std::size_t letter_size(std::string_view text) {
    std::size_t size = 1;
    while (size < text.size() && (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U) {
        ++size;
    }
    return size;
}

} // namespace

bool is_like(std::string_view text, std::string_view pattern) {
    std::string_view after_any, tried; // the rest of the pattern after the last %, and its text
    bool has_any = false;
    while (!text.empty()) {
        if (pattern.starts_with('%')) {
            pattern.remove_prefix(1);
            after_any = pattern;
            tried = text;
            has_any = true;
            continue;
        }
        const bool is_escaped = pattern.size() > 1 && pattern.front() == '\\';
        const auto wanted = pattern.substr(is_escaped ? 1 : 0);
        if (!is_escaped && wanted.starts_with('_')) {
            pattern.remove_prefix(1);
            text.remove_prefix(letter_size(text));
        } else if (!wanted.empty() && wanted.front() == text.front()) {
            pattern = wanted.substr(1);
            text.remove_prefix(1);
        } else if (has_any) { // the last % takes one letter more
            tried.remove_prefix(letter_size(tried));
            text = tried;
            pattern = after_any;
        } else {
            return false;
        }
    }
    return pattern.find_first_not_of('%') == std::string_view::npos;
}

} // namespace macadam
