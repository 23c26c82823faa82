#include "storage/tables/excel_csv.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <stdexcept>
#include <utility>

namespace macadam {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

// Decimal marks by language: Unicode CLDR 42, symbols/decimal of the latn numbers.
constexpr std::array<std::string_view, 33> with_comma{
    "be", "bg", "bs", "ca", "cs", "da", "de", "el", "es", "et", "eu",
    "fi", "fr", "gl", "hr", "hu", "id", "is", "it", "lt", "lv", "nb",
    "nl", "nn", "no", "pl", "pt", "ro", "ru", "sk", "sl", "sr", "sv"};
constexpr std::array<std::string_view, 2> with_comma_too{"tr", "uk"};
constexpr std::array<std::string_view, 9> with_point{
    "C", "POSIX", "en", "ga", "he", "ja", "ko", "th", "zh"};

// Countries that differ from the language: decimal points with semicolons between cells, and
// decimal points as in the United States.
constexpr std::array<std::string_view, 3> points_and_semicolons{"de_CH", "de_LI", "it_CH"};
constexpr std::array<std::string_view, 8> american{
    "es_MX", "es_US", "es_PR", "es_GT", "es_HN", "es_NI", "es_PA", "es_SV"};

template <typename Names>
bool has(const Names& names, std::string_view name) {
    return std::ranges::find(names, name) != names.end();
}

bool is_digit(char c) {
    return '0' <= c && c <= '9';
}

/// Tests for a number, or a list of numbers with semicolons between them.
bool is_numeric(std::string_view text) {
    bool has_digit = false;
    for (const char c : text) {
        has_digit = has_digit || is_digit(c);
        if (!is_digit(c) && c != '.' && c != '-' && c != '+' && c != 'e' && c != ';') {
            return false;
        }
    }
    return has_digit;
}

} // namespace

ExcelDialect excel_dialect(std::string_view locale) {
    std::string place{locale.substr(0, locale.find_first_of(".@"))};
    std::ranges::replace(place, '-', '_'); // "de-CH" of the web is "de_CH"
    const auto language = place.substr(0, place.find('_'));
    if (has(points_and_semicolons, place)) {
        return {';', '.'};
    }
    if (has(with_point, language) || has(american, place)) {
        return {};
    }
    if (has(with_comma, language) || has(with_comma_too, language)) {
        return {';', ','};
    }
    throw std::invalid_argument{fmt::format("expected a language such as en, {}, {}",
                                            fmt::join(with_comma, ", "),
                                            fmt::join(with_comma_too, ", "))};
}

std::string numeric_locale() {
    for (const auto* const variable : {"LC_ALL", "LC_NUMERIC", "LANG"}) {
        const char* const value = std::getenv(variable); // NOLINT(concurrency-mt-unsafe)
        if (value != nullptr && *value != '\0') {
            return value;
        }
    }
    return "C";
}

std::string ExcelCsv::finished_cell() {
    auto cell = std::exchange(cell_, {});
    if (cell.starts_with('"')) {
        return cell;
    }
    if (is_numeric(cell)) {
        std::ranges::replace(cell, '.', dialect_.decimal_mark);
    }
    return cell.find(dialect_.separator) == std::string::npos ? cell : fmt::format("\"{}\"", cell);
}

std::string ExcelCsv::operator()(std::string_view csv) {
    std::string text;
    if (!std::exchange(has_begun_, true)) {
        text += byte_order_mark;
    }
    for (const char c : csv) {
        if (!is_quoted_ && (c == ',' || c == '\n')) {
            text += finished_cell();
            text += c == ',' ? dialect_.separator : c;
            continue;
        }
        is_quoted_ = is_quoted_ != (c == '"');
        cell_ += c;
    }
    return text;
}

} // namespace macadam
