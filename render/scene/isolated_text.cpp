#include "render/scene/isolated_text.hpp"

#include "estimator/common/utf8.hpp"

#include <algorithm>
#include <utility>

namespace macadam {
namespace {

/// Tests for letters of scripts that run from right to left, from Hebrew to Arabic with their
/// presentation forms, and the old ones.
bool runs_leftwards(std::uint32_t letter) {
    constexpr std::pair<std::uint32_t, std::uint32_t> blocks[] = {{0x0590, 0x08FF},
                                                                  {0xFB1D, 0xFDFF},
                                                                  {0xFE70, 0xFEFF},
                                                                  {0x10800, 0x10FFF},
                                                                  {0x1E800, 0x1EFFF}};
    return std::ranges::any_of(blocks, [letter](const auto& block) {
        return block.first <= letter && letter <= block.second;
    });
}

} // namespace

std::string without_direction_controls(std::string_view text) {
    std::string clean;
    while (!text.empty()) {
        const auto letter = text.substr(0, std::max<std::size_t>(1, utf8_length(text)));
        if (!is_bidi_control(utf8_letter(letter))) {
            clean += letter;
        }
        text.remove_prefix(letter.size());
    }
    return clean;
}

std::string isolated(std::string_view name) {
    auto clean = without_direction_controls(name);
    for (std::string_view rest{clean}; !rest.empty();) {
        const auto letter = rest.substr(0, std::max<std::size_t>(1, utf8_length(rest)));
        if (runs_leftwards(utf8_letter(letter))) {
            return "\u2068" + clean + "\u2069";
        }
        rest.remove_prefix(letter.size());
    }
    return clean;
}

} // namespace macadam
