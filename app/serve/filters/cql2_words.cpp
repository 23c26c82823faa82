#include "app/serve/filters/cql2_words.hpp"

#include "app/serve/filters/cql2_expression.hpp"
#include "estimator/common/ascii.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace macadam {
namespace {

bool is_digit(char letter) {
    return letter >= '0' && letter <= '9';
}

/// Letters outside of ASCII are taken as they are.
bool is_name_letter(char letter) {
    return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') || letter == '_' ||
           letter == ':' || static_cast<unsigned char>(letter) >= 0x80;
}

std::size_t name_size(std::string_view text) {
    if (text.empty() || !is_name_letter(text.front())) {
        return 0;
    }
    const auto* const end = std::ranges::find_if_not(text, [](char letter) {
        return is_name_letter(letter) || is_digit(letter) || letter == '.';
    });
    return static_cast<std::size_t>(end - text.begin());
}

} // namespace

std::string_view Cql2Words::rest() {
    at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size());
    return text_.substr(at_);
}

bool Cql2Words::is_at(char sign) {
    return rest().starts_with(sign);
}

bool Cql2Words::take(std::string_view sign) {
    const bool is_next = rest().starts_with(sign);
    at_ += is_next ? sign.size() : 0;
    return is_next;
}

bool Cql2Words::take_word(std::string_view word) {
    const auto next = rest().substr(0, name_size(rest()));
    const bool is_next = in_lower_case(next) == word;
    at_ += is_next ? word.size() : 0;
    return is_next;
}

std::string Cql2Words::name() {
    const std::string name{rest().substr(0, name_size(rest()))};
    at_ += name.size();
    return name;
}

std::string Cql2Words::quoted_name() {
    expect("\"");
    const auto end = text_.find('"', at_);
    if (end == std::string_view::npos) {
        throw Cql2Error{"a name in double quotes does not end"};
    }
    std::string name{text_.substr(at_, end - at_)};
    at_ = end + 1;
    return name;
}

std::string Cql2Words::quoted() {
    expect("'");
    std::string text;
    while (at_ < text_.size()) {
        const auto two = text_.substr(at_, 2);
        if (two == "''" || two == "\\'") {
            text += '\'';
            at_ += 2;
        } else if (text_[at_] == '\'') {
            ++at_;
            return text;
        } else {
            text += text_[at_++];
        }
    }
    throw Cql2Error{"a text in quotes does not end"};
}

std::optional<double> Cql2Words::number() {
    auto next = rest();
    const bool has_sign = next.starts_with('-') || next.starts_with('+');
    const auto digits = next.substr(has_sign ? 1 : 0);
    const bool is_number =
        !digits.empty() && (is_digit(digits.front()) ||
                            (digits.size() > 1 && digits.front() == '.' && is_digit(digits[1])));
    if (!is_number) {
        return std::nullopt;
    }
    const auto begin = next.starts_with('+') ? digits : next; // from_chars knows no plus
    double value = 0;
    const auto [end, error] = std::from_chars(begin.data(), begin.data() + begin.size(), value);
    if (error != std::errc{} || !std::isfinite(value)) {
        refuse("a number within 1e308");
    }
    at_ += static_cast<std::size_t>(end - next.data());
    return value;
}

void Cql2Words::expect(std::string_view sign) {
    if (!take(sign)) {
        refuse(sign);
    }
}

void Cql2Words::expect_word(std::string_view word) {
    if (!take_word(word)) {
        refuse(word);
    }
}

void Cql2Words::expect_end() {
    if (!rest().empty()) {
        refuse("AND, OR or the end");
    }
}

void Cql2Words::refuse(std::string_view expected, std::string_view found) {
    const auto next = found.empty() ? rest() : found;
    constexpr std::size_t longest = 20;
    throw Cql2Error{fmt::format("after {} letters there is {}, expected {}",
                                at_ - found.size(),
                                next.empty() ? "the end" : in_quotes(next, longest),
                                expected)};
}

} // namespace macadam
