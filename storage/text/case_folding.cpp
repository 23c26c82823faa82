#include "storage/text/case_folding.hpp"

#include "estimator/common/utf8.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace macadam {
namespace {

/// Range of characters with a common folding rule: every `step`-th from first to last is shifted by
/// `shift`.
struct Rule {
    std::uint32_t first;
    std::uint32_t last;
    std::uint32_t step;
    std::int32_t shift;
};

// Unicode 15, CaseFolding.txt, in the order of the characters.
constexpr std::array rules{
    Rule{0x0041, 0x005a, 1, 32},    Rule{0x00c0, 0x00d6, 1, 32},    Rule{0x00d8, 0x00de, 1, 32},
    Rule{0x0100, 0x012e, 2, 1},     Rule{0x0132, 0x0136, 2, 1},     Rule{0x0139, 0x0147, 2, 1},
    Rule{0x014a, 0x0176, 2, 1},     Rule{0x0178, 0x0178, 1, -121},  Rule{0x0179, 0x017d, 2, 1},
    Rule{0x017f, 0x017f, 1, -268},  Rule{0x0181, 0x0181, 1, 210},   Rule{0x018a, 0x018a, 1, 205},
    Rule{0x018f, 0x018f, 1, 202},   Rule{0x0190, 0x0190, 1, 203},   Rule{0x0198, 0x0198, 1, 1},
    Rule{0x01a0, 0x01a4, 2, 1},     Rule{0x01af, 0x01af, 1, 1},     Rule{0x01cd, 0x01db, 2, 1},
    Rule{0x01de, 0x01ee, 2, 1},     Rule{0x01f8, 0x021e, 2, 1},     Rule{0x0222, 0x0232, 2, 1},
    Rule{0x0386, 0x0386, 1, 38},    Rule{0x0388, 0x038a, 1, 37},    Rule{0x038c, 0x038c, 1, 64},
    Rule{0x038e, 0x038f, 1, 63},    Rule{0x0391, 0x03a1, 1, 32},    Rule{0x03a3, 0x03ab, 1, 32},
    Rule{0x03c2, 0x03c2, 1, 1},     Rule{0x0400, 0x040f, 1, 80},    Rule{0x0410, 0x042f, 1, 32},
    Rule{0x0460, 0x0480, 2, 1},     Rule{0x048a, 0x04be, 2, 1},     Rule{0x04c0, 0x04c0, 1, 15},
    Rule{0x04c1, 0x04cd, 2, 1},     Rule{0x04d0, 0x052e, 2, 1},     Rule{0x0531, 0x0556, 1, 48},
    Rule{0x1c90, 0x1cba, 1, -3008}, Rule{0x1cbd, 0x1cbf, 1, -3008}, Rule{0x1e00, 0x1e94, 2, 1},
    Rule{0x1ea0, 0x1efe, 2, 1},     Rule{0xff21, 0xff3a, 1, 32}};

std::uint32_t folded(std::uint32_t letter) {
    const auto* const after = std::ranges::upper_bound(rules, letter, {}, &Rule::first);
    if (after == rules.begin()) {
        return letter;
    }
    const auto& rule = *(after - 1);
    const bool holds = letter <= rule.last && (letter - rule.first) % rule.step == 0;
    return holds ? letter + static_cast<std::uint32_t>(rule.shift) : letter;
}

std::string utf8_of(std::uint32_t letter) {
    const auto last = [&](int shift) {
        return static_cast<char>(0x80U | (letter >> shift & 0x3fU));
    };
    if (letter < 0x80) {
        return {static_cast<char>(letter)};
    }
    if (letter < 0x800) {
        return {static_cast<char>(0xc0U | letter >> 6), last(0)};
    }
    return {static_cast<char>(0xe0U | letter >> 12), last(6), last(0)};
}

} // namespace

std::string case_folded(std::string_view text) {
    constexpr std::uint32_t sharp_s = 0xdf, capital_sharp_s = 0x1e9e;
    std::string out;
    out.reserve(text.size());
    while (!text.empty()) {
        const auto bytes = utf8_length(text);
        const auto sequence = text.substr(0, std::max<std::size_t>(1, bytes));
        const auto letter = bytes == 0 ? 0 : utf8_letter(sequence);
        if (letter == sharp_s || letter == capital_sharp_s) {
            out += "ss";
        } else if (const auto to = folded(letter); to != letter) {
            out += utf8_of(to);
        } else {
            out += sequence;
        }
        text.remove_prefix(sequence.size());
    }
    return out;
}

} // namespace macadam
