#include "storage/trips/mappings/dbc_tokens.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/exact_number.hpp"
#include "storage/text/text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace macadam {

DbcTokens::DbcTokens(std::string_view rest, std::string where)
    : rest_{rest}, where_{std::move(where)} {}

std::string_view DbcTokens::word() {
    rest_ = trimmed(rest_);
    const auto word = rest_.substr(0, rest_.find_first_of(" \t:|@(),[];\""));
    rest_.remove_prefix(word.size());
    return word;
}

std::string DbcTokens::name(std::string_view expected) {
    const auto found = word();
    if (found.empty()) {
        refuse(expected);
    }
    return std::string{found};
}

bool DbcTokens::at_end() const {
    return trimmed(rest_).empty();
}

bool DbcTokens::has(char sign) {
    rest_ = trimmed(rest_);
    if (!rest_.starts_with(sign)) {
        return false;
    }
    rest_.remove_prefix(1);
    return true;
}

void DbcTokens::expect(char sign) {
    if (!has(sign)) {
        refuse(fmt::format("'{}'", sign));
    }
}

std::uint64_t DbcTokens::whole(std::uint64_t low, std::uint64_t high) {
    const auto text = word();
    const auto number = exact_number<std::uint64_t>(text);
    if (!number || *number < low || *number > high) {
        rest_ = {text.data(), static_cast<std::size_t>(rest_.data() + rest_.size() - text.data())};
        refuse(fmt::format("a whole number from {} to {}", low, high));
    }
    return *number;
}

double DbcTokens::number() {
    const auto before = rest_;
    const auto number = parse_number(word());
    if (!number || !std::isfinite(*number)) {
        rest_ = before;
        refuse("a number");
    }
    return *number;
}

std::string DbcTokens::quoted() {
    expect('"');
    const auto text = rest_.substr(0, rest_.find('"'));
    rest_.remove_prefix(std::min(rest_.size(), text.size() + 1));
    return std::string{text};
}

void DbcTokens::refuse(std::string_view expected) const {
    throw InputError{fmt::format("{}: {}, expected {}",
                                 where_,
                                 at_end() ? "the statement ends" : in_quotes(trimmed(rest_)),
                                 expected)};
}

} // namespace macadam
