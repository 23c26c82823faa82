#include "storage/profiles/fixed_fields.hpp"

#include "storage/text/text.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string>

namespace macadam {

namespace {

constexpr std::size_t max_fields = 10'000; // per line; a short format can ask for more
constexpr std::size_t longest_line = 100'000;
constexpr int deepest = 20; // nested brackets

/// Parses a format from left to right. After an unknown descriptor, failed() is true.
class FormatReader {
public:
    explicit FormatReader(std::string_view format) : rest_{format} {}

    std::vector<FixedField> fields() {
        items(0);
        return failed_ || !rest_.empty() ? std::vector<FixedField>{} : std::move(fields_);
    }

private:
    void items(int depth) {
        while (!failed_ && !rest_.empty() && rest_.front() != ')') {
            if (rest_.front() == ',') {
                rest_.remove_prefix(1);
            } else {
                item(depth);
            }
        }
    }

    void item(int depth) {
        const auto times = whole_number().value_or(1);
        const char letter = rest_.empty() ? '\0' : rest_.front();
        if (letter == '(') {
            group(times, depth);
            return;
        }
        rest_.remove_prefix(std::min<std::size_t>(1, rest_.size()));
        if (letter == 'X') {
            column_ += times;
        } else if (std::string_view{"FEDGI"}.find(letter) != std::string_view::npos &&
                   letter != '\0') {
            numbers(times);
        } else if (letter != 'P') { // 1P shifts the decimal point of output only
            failed_ = true;
        }
    }

    void group(std::size_t times, int depth) {
        rest_.remove_prefix(1);
        const auto inner = rest_;
        failed_ = failed_ || depth >= deepest || times == 0 || times > max_fields;
        for (std::size_t i = 0; i < times && !failed_; ++i) {
            rest_ = inner;
            const auto before = column_;
            items(depth + 1);
            failed_ =
                failed_ || !rest_.starts_with(')') || column_ == before || column_ > longest_line;
        }
        rest_.remove_prefix(std::min<std::size_t>(1, rest_.size()));
    }

    /// Parses Fw.d or Ew.dEe.
    void numbers(std::size_t times) {
        if (rest_.starts_with('S') || rest_.starts_with('N')) {
            rest_.remove_prefix(1);
        }
        const auto width = whole_number().value_or(0);
        std::size_t decimals = 0;
        if (rest_.starts_with('.')) {
            rest_.remove_prefix(1);
            decimals = whole_number().value_or(max_fields);
            if (rest_.starts_with('E')) {
                rest_.remove_prefix(1);
                whole_number();
            }
        }
        constexpr std::size_t widest = 100;
        failed_ = failed_ || width == 0 || width > widest || decimals > width ||
                  fields_.size() + times > max_fields;
        for (std::size_t i = 0; i < times && !failed_; ++i) {
            fields_.push_back({column_, width, static_cast<int>(decimals)});
            column_ += width;
        }
    }

    std::optional<std::size_t> whole_number() {
        std::size_t number = 0;
        const auto [stop, error] =
            std::from_chars(rest_.data(), rest_.data() + rest_.size(), number);
        if (error != std::errc{} || number > max_fields) {
            return {};
        }
        rest_.remove_prefix(static_cast<std::size_t>(stop - rest_.data()));
        return number;
    }

    std::string_view rest_;
    std::vector<FixedField> fields_;
    std::size_t column_ = 0;
    bool failed_ = false;
};

std::string upper_without_blanks(std::string_view text) {
    std::string upper;
    for (const char c : text) {
        if (c != ' ' && c != '\t') {
            upper += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        }
    }
    return upper;
}

} // namespace

std::vector<FixedField> fields_of_format(std::string_view format) {
    return FormatReader{upper_without_blanks(format)}.fields();
}

std::optional<double> fortran_number(std::string_view text, int decimals) {
    text = trimmed(text);
    auto number = parse_number(text);
    if (!number && text.find_first_of("dD") != std::string_view::npos) {
        std::string copy{text};
        std::ranges::replace(copy, 'd', 'e');
        std::ranges::replace(copy, 'D', 'e');
        number = parse_number(copy);
    }
    if (number && !std::isfinite(*number)) {
        return {};
    }
    if (number && decimals > 0 && text.find_first_of(".eEdD") == std::string_view::npos) {
        *number /= std::pow(10.0, decimals);
    }
    return number;
}

} // namespace macadam
