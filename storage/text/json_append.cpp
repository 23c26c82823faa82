#include "storage/text/json_append.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <iterator>

namespace macadam {
namespace {

constexpr std::array<double, 8> powers{1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7};

/// Appends a whole number with its last digits behind a point.
void append_scaled(std::string& text, bool is_negative, std::uint64_t scaled, int decimals) {
    std::array<char, 24> letters{};
    auto* const end = letters.data() + letters.size();
    auto* first = end;
    for (int i = 0; i < decimals; ++i, scaled /= 10) {
        *--first = static_cast<char>('0' + scaled % 10);
    }
    if (decimals > 0) {
        *--first = '.';
    }
    do {
        *--first = static_cast<char>('0' + scaled % 10);
        scaled /= 10;
    } while (scaled > 0);
    if (is_negative) {
        *--first = '-';
    }
    text.append(first, end);
}

struct AppendJson {
    std::string* text;
    const ColumnType* type;

    void operator()(std::monostate) const { *text += "null"; }
    void operator()(bool value) const { *text += value ? "true" : "false"; }
    void operator()(std::int64_t value) const {
        std::array<char, 24> letters{};
        const auto* const end =
            std::to_chars(letters.data(), letters.data() + letters.size(), value).ptr;
        text->append(letters.data(), static_cast<std::size_t>(end - letters.data()));
    }
    void operator()(double value) const {
        if (type->decimals == ColumnType::shortest) {
            fmt::format_to(std::back_inserter(*text), "{}", value);
            return;
        }
        const auto begin = text->size();
        append_fixed(*text, value, type->decimals);
        const bool is_zero = text->find_first_of("123456789", begin) == std::string::npos;
        if (is_zero && (*text)[begin] == '-') {
            text->erase(begin, 1);
        }
    }
    void operator()(const std::string& value) const {
        if (type->kind == ColumnType::Kind::raw) {
            *text += value;
        } else {
            append_json_text(*text, value);
        }
    }
};

} // namespace

void append_fixed(std::string& text, double value, int decimals) {
    // The product has an error below 1e-6 up to this: only a number so near to the middle between
    // two results is left to the exact way.
    constexpr double most = 4e9, middle = 0.5 - 1e-6;
    if (decimals >= 0 && static_cast<std::size_t>(decimals) < powers.size()) {
        const double scaled = std::abs(value) * powers[static_cast<std::size_t>(decimals)];
        const double whole = std::nearbyint(scaled);
        if (scaled < most && std::abs(scaled - whole) < middle) {
            append_scaled(text, std::signbit(value), static_cast<std::uint64_t>(whole), decimals);
            return;
        }
    }
    fmt::format_to(std::back_inserter(text), "{:.{}f}", value, decimals);
}

void append_json(std::string& text, const ColumnType& type, const Cell& cell) {
    std::visit(AppendJson{&text, &type}, cell.value());
}

} // namespace macadam
