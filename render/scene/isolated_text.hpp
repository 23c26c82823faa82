#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace macadam {

/// Controls around a text whose direction is its own (UAX 9, 2.4): FIRST STRONG ISOLATE and POP
/// DIRECTIONAL ISOLATE.
inline constexpr std::uint32_t isolate_begin = 0x2068;
inline constexpr std::uint32_t isolate_end = 0x2069;

/// Returns a name for use within a sentence. One with letters that run from right to left is
/// isolated, so that numbers after it are not drawn into it.
std::string isolated(std::string_view name);

/// Returns a text without controls of its direction.
std::string without_direction_controls(std::string_view text);

} // namespace macadam
