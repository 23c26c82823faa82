#include "mutation.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace macadam::fuzz {
namespace {

constexpr std::size_t largest_bytes = 1 << 18; // of an input: what is longer takes long, no more
constexpr std::size_t longest_block = 256;

constexpr std::array<std::string_view, 16> extreme_numbers{"0",
                                                           "-1",
                                                           "-0.0",
                                                           "1e308",
                                                           "-1e308",
                                                           "1e-320",
                                                           "nan",
                                                           "inf",
                                                           "2147483648",
                                                           "4294967296",
                                                           "9223372036854775807",
                                                           "-9223372036854775808",
                                                           "18446744073709551616",
                                                           "1e400",
                                                           "0x7f",
                                                           ""};

constexpr std::array<unsigned char, 8> extreme_bytes{0, 1, 0x7f, 0x80, 0xff, '"', '\n', ','};

bool is_of_number(char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-';
}

/// The line that holds a place, with its newline.
std::pair<std::size_t, std::size_t> line_at(const std::string& text, std::size_t at) {
    const auto newline_before = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
    const auto begin = newline_before == std::string::npos ? 0 : newline_before + 1;
    const auto newline = text.find('\n', at);
    return {begin, newline == std::string::npos ? text.size() : newline + 1};
}

} // namespace

Mutation::Mutation(std::vector<std::string> seeds,
                   std::vector<std::string> words,
                   std::uint64_t start)
    : seeds_{std::move(seeds)}, words_{std::move(words)}, random_{start} {}

std::size_t Mutation::below(std::size_t past) {
    return past == 0 ? 0 : random_() % past; // a distribution differs between libraries
}

std::string_view Mutation::one_of(const std::vector<std::string>& texts) {
    return texts.empty() ? std::string_view{} : texts[below(texts.size())];
}

std::string Mutation::next() {
    std::string input{one_of(seeds_)};
    const auto changes = 1 + below(4);
    for (std::size_t i = 0; i < changes; ++i) {
        change(input);
    }
    if (input.size() > largest_bytes) {
        input.resize(largest_bytes);
    }
    return input;
}

void Mutation::change(std::string& input) {
    switch (below(8)) {
    case 0:
    case 1:
        return change_bytes(input);
    case 2:
    case 3:
        return change_blocks(input);
    case 4:
    case 5:
        return change_number(input);
    case 6:
        return change_lines(input);
    default:
        input.insert(below(input.size() + 1), one_of(words_));
    }
}

void Mutation::change_bytes(std::string& input) {
    if (input.empty()) {
        input.push_back(static_cast<char>(below(256)));
        return;
    }
    auto& byte = input[below(input.size())];
    switch (below(3)) {
    case 0:
        byte = static_cast<char>(static_cast<unsigned char>(byte) ^ (1U << below(8)));
        return;
    case 1:
        byte = static_cast<char>(below(256));
        return;
    default:
        byte = static_cast<char>(extreme_bytes[below(extreme_bytes.size())]);
    }
}

void Mutation::change_blocks(std::string& input) {
    const auto at = below(input.size());
    const auto block = input.substr(at, 1 + below(longest_block));
    switch (below(6)) {
    case 0:
        input.erase(at, block.size());
        return;
    case 1:
        input.insert(at, block);
        return;
    case 2:
        input.insert(below(input.size() + 1), block);
        return;
    case 3:
        input.replace(std::min(input.size(), below(input.size() + 1)), block.size(), block);
        return;
    case 4: { // the head of one, the tail of another
        const auto other = one_of(seeds_);
        input.resize(at);
        input += other.substr(below(other.size() + 1));
        return;
    }
    default:
        input.resize(at);
    }
}

void Mutation::change_number(std::string& input) {
    const auto from = below(input.size());
    const auto begin =
        std::find_if(input.begin() + static_cast<std::ptrdiff_t>(from), input.end(), is_of_number);
    const auto end = std::find_if_not(begin, input.end(), is_of_number);
    if (begin != end) {
        input.replace(begin, end, extreme_numbers[below(extreme_numbers.size())]);
    }
}

void Mutation::change_lines(std::string& input) {
    const auto [begin, end] = line_at(input, below(input.size()));
    const auto line = input.substr(begin, end - begin);
    if (below(2) == 0) {
        input.erase(begin, line.size());
    }
    const auto to = line_at(input, below(input.size())).first;
    input.insert(to, line);
}

} // namespace macadam::fuzz
