#include "storage/profiles/erd_header.hpp"

#include "estimator/common/error.hpp"
#include "storage/profiles/length_unit.hpp"
#include "storage/text/text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <string_view>

namespace macadam {

namespace {

constexpr std::string_view first_line = "ERDFILEV2.00";
constexpr std::size_t keyword_width = 8;
constexpr std::size_t short_width = 8; // of SHORTNAM and UNITSNAM
constexpr std::size_t long_width = 32; // of LONGNAME
constexpr double max_channels = 1000;  // of a vehicle simulation; profiles have 1 to 5

/// Text of each keyword, from column 9 on.
using Keywords = std::map<std::string, std::string, std::less<>>;

std::string_view required_line(TextLines& lines, const char* expected) {
    const auto line = lines.next();
    if (!line) {
        throw InputError{fmt::format("{}: ends here, expected {}", lines.where(), expected)};
    }
    return *line;
}

std::string upper(std::string_view text) {
    std::string word{trimmed(text)};
    std::ranges::transform(
        word, word.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return word;
}

/// Numbers separated by commas or blanks, up to the first word that is not a number.
std::vector<double> leading_numbers(std::string_view text) {
    constexpr std::string_view between = " \t,";
    std::vector<double> numbers;
    for (;;) {
        text.remove_prefix(std::min(text.find_first_not_of(between), text.size()));
        const auto word = text.substr(0, text.find_first_of(between));
        const auto number = fortran_number(word);
        if (!number) {
            return numbers;
        }
        numbers.push_back(*number);
        text.remove_prefix(word.size());
    }
}

/// Second line: channels, samples, records, bytes per record, key number, step, and a key that
/// profiles do not use.
struct Layout {
    std::size_t channels;
    std::optional<std::size_t> samples;
    ErdNumbers numbers;
    double step;
};

Layout read_layout(TextLines& lines) {
    constexpr std::size_t needed = 6;
    const auto line = required_line(lines, "the numbers of channels and samples");
    const auto numbers = leading_numbers(line);
    if (numbers.size() < needed) {
        throw InputError{fmt::format("{}: {}, expected six numbers: channels, samples, records, "
                                     "bytes of a record, key number and step",
                                     lines.where(),
                                     in_quotes(line, 80))};
    }
    const auto bad = [&](const char* what, double value, const char* expected) {
        return InputError{
            fmt::format("{}: {} '{:g}', expected {}", lines.where(), what, value, expected)};
    };
    constexpr double max_samples = 1e12;
    if (!(numbers[0] >= 1 && numbers[0] <= max_channels) || numbers[0] != std::floor(numbers[0])) {
        throw bad("number of channels", numbers[0], "1 to 1000");
    }
    if (numbers[1] > max_samples || numbers[1] != std::floor(numbers[1])) {
        throw bad("number of samples", numbers[1], "a whole number");
    }
    if (numbers[4] != 0 && numbers[4] != 1 && numbers[4] != 5) {
        throw bad("key number",
                  numbers[4],
                  "5 (text), or 0 or 1 (2-byte integers or 4-byte floats in a .bin)");
    }
    if (numbers[5] < 0) {
        throw bad("step", numbers[5], "a length above 0");
    }
    return {.channels = static_cast<std::size_t>(numbers[0]),
            .samples =
                numbers[1] > 0 ? std::optional{static_cast<std::size_t>(numbers[1])} : std::nullopt,
            .numbers = ErdNumbers{static_cast<std::uint8_t>(numbers[4])},
            .step = numbers[5]};
}

/// Reads the keywords. A keyword that begins with & continues the previous one at the next whole
/// field.
Keywords read_keywords(TextLines& lines) {
    Keywords keywords;
    auto current = keywords.end();
    for (;;) {
        const auto line = required_line(lines, "the end of the header, END");
        const auto keyword = upper(line.substr(0, keyword_width));
        if (keyword == "END") {
            return keywords;
        }
        const auto text = line.substr(std::min(keyword_width, line.size()));
        if (keyword.starts_with('&') && current != keywords.end()) {
            auto& whole = current->second;
            const auto width = current->first == "LONGNAME" ? long_width : short_width;
            whole.resize((whole.size() + width - 1) / width * width, ' ');
            whole += text;
        } else if (!keyword.empty()) {
            current = keywords.emplace(keyword, text).first;
        }
    }
}

std::string_view text_of(const Keywords& keywords, std::string_view keyword) {
    const auto found = keywords.find(keyword);
    return found == keywords.end() ? std::string_view{} : found->second;
}

std::string field(std::string_view text, std::size_t index, std::size_t width) {
    return std::string{trimmed(text.substr(std::min(index * width, text.size()), width))};
}

std::vector<ErdHeader::Channel> channels_of(const Keywords& keywords, std::size_t count) {
    const auto gains = leading_numbers(text_of(keywords, "GAIN"));
    std::vector<ErdHeader::Channel> channels(count);
    for (std::size_t i = 0; i < count; ++i) {
        channels[i].name = field(text_of(keywords, "SHORTNAM"), i, short_width);
        if (channels[i].name.empty()) {
            channels[i].name = field(text_of(keywords, "LONGNAME"), i, long_width);
        }
        channels[i].unit = field(text_of(keywords, "UNITSNAM"), i, short_width);
        channels[i].gain = i < gains.size() ? gains[i] : 1;
    }
    return channels;
}

} // namespace

ErdHeader read_erd_header(TextLines& lines) {
    const auto line = required_line(lines, "'ERDFILEV2.00'");
    if (!upper(line).starts_with(first_line)) {
        throw InputError{
            fmt::format("{}: {}, expected '{}'", lines.where(), in_quotes(line), first_line)};
    }
    const auto layout = read_layout(lines);
    const auto keywords = read_keywords(lines);
    const auto unit_m = metres_in(text_of(keywords, "XUNITS"));
    const auto start = leading_numbers(text_of(keywords, "XSTART"));
    return {.channels = channels_of(keywords, layout.channels),
            .samples = layout.samples,
            .numbers = layout.numbers,
            .step_m =
                unit_m && layout.step > 0 ? std::optional{layout.step * *unit_m} : std::nullopt,
            .start_m = unit_m && !start.empty() ? start.front() * *unit_m : 0,
            .title = std::string{trimmed(text_of(keywords, "TITLE"))},
            .format = fields_of_format(text_of(keywords, "FORMAT"))};
}

} // namespace macadam
